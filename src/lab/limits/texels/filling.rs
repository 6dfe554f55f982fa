//! Filling by parity, the appendix' way, against flooding, on shapes of which every voxel is known.

use bevy::math::{UVec3, Vec3};

pub use super::solids::Solid;
use crate::lab::charts::{Axis, Chart, Series};
use crate::lab::limits;
use crate::texel::build::{Filling, ShapeSettings, from_shape};
use crate::texel::silent;

/// Voxels along each side of the volumes of the chart.
const SIDES: [u32; 4] = [16, 32, 64, 128];
/// In place of no wrong voxel, on the chart.
const NONE: f64 = 1e-5;

/// What a filling gets wrong.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wrong {
    /// Voxels that are empty inside or opaque outside, in shares of the shape's; not those within half a diagonal of the
    /// surface, which may be either.
    pub voxels: f64,
    /// Columns that the filling itself finds to be wrong, in shares of all.
    pub noticed: f64,
}

/// Fills a shape in `side`³ voxels.
pub fn measure(solid: Solid, filling: Filling, side: u32) -> Wrong {
    let settings = ShapeSettings {
        bounds: Some([Vec3::ZERO, Vec3::ONE]),
        filling,
        ..ShapeSettings::new(UVec3::splat(side))
    };
    let built = from_shape(&solid.shape(), &settings, &silent).expect("the shape is closed");
    let voxel = 1.0 / side as f32;
    // And what the polygons are off.
    let unsure = voxel * (0.5 * 3f32.sqrt() + 0.1);
    let (mut inside, mut wrong) = (0, 0);
    for index in 0..side.pow(3) {
        let [x, y, z] = [index % side, index / side % side, index / (side * side)];
        let centre = (Vec3::new(x as f32, y as f32, z as f32) + 0.5) * voxel;
        let distance = solid.distance(centre);
        inside += u32::from(distance < 0.0);
        let is_wrong = built.volume.is_opaque(x, y, z) != (distance < 0.0);
        wrong += u32::from(is_wrong && distance.abs() > unsure);
    }
    Wrong {
        voxels: f64::from(wrong) / f64::from(inside),
        noticed: built.report.failed_columns as f64 / f64::from(side * side),
    }
}

/// The chart.
pub fn chart() -> Chart {
    let line = |name: String, wrong: &dyn Fn(u32) -> f64| {
        Series::line(name, SIDES.map(|side| (f64::from(side), wrong(side))))
    };
    let parity = Solid::ALL.map(|solid| {
        line(format!("parity: {}", solid.name()), &|side| {
            measure(solid, Filling::Parity, side).voxels
        })
    });
    let flood = line("flood: all of them".into(), &|side| {
        let wrong = Solid::ALL.map(|solid| measure(solid, Filling::Flood, side).voxels);
        wrong.into_iter().fold(0.0, f64::max)
    });
    limits::chart(
        "Voxels that filling gets wrong",
        Axis::log("voxels along each side"),
        Axis::log("share of the shape's voxels (1e-5 stands for less)").with_floor(NONE),
        parity.into_iter().chain([flood]).collect(),
    )
}

#[cfg(test)]
mod tests {
    use core::f32::consts::PI;

    use super::super::solids::{BALLS, RADIUS};
    use super::*;

    #[test]
    fn flooding_gets_no_voxel_wrong() {
        for solid in Solid::ALL {
            for side in [16, 32, 64] {
                let Wrong { voxels, noticed } = measure(solid, Filling::Flood, side);
                assert_eq!((voxels, noticed), (0.0, 0.0), "{solid:?} {side}");
            }
        }
    }

    #[test]
    fn parity_takes_what_two_balls_share_for_the_outside() {
        // The volume of the lens, in shares of both balls', by its half height c and the radius of its two caps.
        let (r, side) = (RADIUS, 64);
        let c = r - 0.5 * BALLS[0].distance(BALLS[1]);
        let lens = 2.0 * PI * c * c * (r - c / 3.0);
        let both = 8.0 / 3.0 * PI * r.powi(3) - lens;
        // Half a diagonal of a voxel within its surface counts neither way.
        let unsure = 4.0 * PI * r * c / side as f32;
        let found = measure(Solid::TwoBalls, Filling::Parity, side);
        let bounds = f64::from((lens - unsure) / both)..=f64::from(lens / both);
        assert!(bounds.contains(&found.voxels), "{found:?} {bounds:?}");
        // And hardly sees it.
        assert!(found.noticed < 0.01, "{found:?}");
    }

    #[test]
    fn parity_fills_what_is_below_a_plate_thinner_than_two_slices() {
        for side in [32, 64] {
            let found = measure(Solid::Plate, Filling::Parity, side);
            // All from the plate to the box is filled, which is 0.25 high over a box of 0.3, less what is near a
            // surface; and the box is emptied.
            let least = 0.25 / 0.3 - 3.0 / f64::from(side) / 0.3;
            assert!(found.voxels > least, "{found:?}");
        }
    }
}
