//! A straight line through texture space, from voxel to voxel (Amanatides and Woo, 1987).

use glam::{DVec3, I64Vec3, IVec2, UVec3};

use crate::texel::ReferenceVolume;

/// The first opaque voxel on a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VoxelHit {
    /// Where the line enters it, or starts in it.
    pub t: f64,
    /// The place: u and v go on over all copies of the volume.
    pub uvw: DVec3,
    /// The voxel.
    pub voxel: UVec3,
    /// Which copy of the volume.
    pub copy: IVec2,
}

/// The first opaque voxel on the line `origin` + t·`dir` in texture space, for t from `range[0]` to `range[1]`, both
/// finite.
///
/// The volume repeats along u and v; outside 0 to 1 along w there is nothing.
pub fn march_voxels(
    volume: &ReferenceVolume,
    origin: DVec3,
    dir: DVec3,
    range: [f64; 2],
) -> Option<VoxelHit> {
    let size = volume.size().as_dvec3();
    // In voxels.
    let (o, d) = (origin * size, dir * size);
    let [mut t, mut t_max] = range;
    if d.z == 0.0 && !(0.0..size.z).contains(&o.z) {
        return None;
    }
    if d.z != 0.0 {
        // Keep to where w is in range, so that the walk is short.
        let [bottom, top] = [-o.z / d.z, (size.z - o.z) / d.z];
        t = t.max(bottom.min(top));
        t_max = t_max.min(bottom.max(top));
    }
    if t.is_nan() || t > t_max {
        return None;
    }
    let start = o + t * d;
    let mut cell = start.floor().as_i64vec3();
    // On a border between two voxels the line is in the one that it goes to.
    for i in 0..3 {
        if d[i] < 0.0 && start[i] == start[i].floor() {
            cell[i] -= 1;
        }
    }
    if d.z != 0.0 {
        // Rounding may have put the start just outside.
        cell.z = cell.z.clamp(0, size.z as i64 - 1);
    }
    while t <= t_max && (0..size.z as i64).contains(&cell.z) {
        if let Some(hit) = look(volume, cell) {
            return Some(VoxelHit {
                t,
                uvw: origin + t * dir,
                ..hit
            });
        }
        // The next border, each computed anew, so that no error adds up.
        let (mut axis, mut next) = (0, f64::INFINITY);
        for i in 0..3 {
            let border = cell[i] + i64::from(d[i] > 0.0);
            let at = (border as f64 - o[i]) / d[i];
            if d[i] != 0.0 && at < next {
                (axis, next) = (i, at);
            }
        }
        if next == f64::INFINITY {
            return None;
        }
        cell[axis] += if d[axis] > 0.0 { 1 } else { -1 };
        t = t.max(next);
    }
    None
}

/// The voxel of a cell, if it is opaque.
pub(super) fn look(volume: &ReferenceVolume, cell: I64Vec3) -> Option<VoxelHit> {
    let size = volume.size().as_i64vec3();
    let voxel = UVec3::new(
        cell.x.rem_euclid(size.x) as u32,
        cell.y.rem_euclid(size.y) as u32,
        u32::try_from(cell.z)
            .ok()
            .filter(|&z| i64::from(z) < size.z)?,
    );
    volume
        .is_opaque(voxel.x, voxel.y, voxel.z)
        .then(|| VoxelHit {
            t: 0.0,
            uvw: DVec3::ZERO,
            voxel,
            copy: IVec2::new(
                cell.x.div_euclid(size.x) as i32,
                cell.y.div_euclid(size.y) as i32,
            ),
        })
}
