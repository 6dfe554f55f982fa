//! Vertices in rings, and triangles between them.

use bevy::math::{DVec2, DVec3};

use super::MeshParts;
use super::normals::{Bulge, smooth_normals};

/// A ring of vertices round a limb: one more than quads, the last at the place of the first.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ring {
    first: u32,
}

/// Who moves the vertices of a ring.
#[derive(Clone, Copy, Debug)]
pub(super) struct Owner {
    pub segment: u32,
    pub neighbour: u32,
}

impl Owner {
    pub fn alone(segment: usize) -> Self {
        let segment = segment as u32;
        Self {
            segment,
            neighbour: segment,
        }
    }
}

/// A mesh in the making.
pub(super) struct Sheet {
    around: u32,
    positions: Vec<DVec3>,
    uvs: Vec<DVec2>,
    owners: Vec<Owner>,
    /// Vertices of one smooth point have one group; its index.
    groups: Vec<u32>,
    group_count: u32,
    triangles: Vec<[u32; 3]>,
    bulges: Vec<Bulge>,
}

impl Sheet {
    /// A sheet whose rings have so many quads.
    pub fn new(around: u32) -> Self {
        Self {
            around,
            positions: Vec::new(),
            uvs: Vec::new(),
            owners: Vec::new(),
            groups: Vec::new(),
            group_count: 0,
            triangles: Vec::new(),
            bulges: Vec::new(),
        }
    }

    pub fn around(&self) -> u32 {
        self.around
    }

    /// u of the k-th vertex of a ring.
    pub fn u(&self, k: u32) -> f64 {
        f64::from(k) / f64::from(self.around)
    }

    /// Adds a ring with the map's `v`, of the points at `point(k)`.
    pub fn ring(&mut self, owner: Owner, v: f64, point: impl Fn(u32) -> DVec3) -> Ring {
        let first = self.positions.len() as u32;
        for k in 0..=self.around {
            // The seam's second vertex is bit by bit where the first is.
            let position = if k < self.around {
                point(k)
            } else {
                self.positions[first as usize]
            };
            let group = self.group_count + k % self.around;
            self.vertex(position, DVec2::new(self.u(k), v), owner, group);
        }
        self.group_count += self.around;
        Ring { first }
    }

    /// A ring at the places of another, behind an edge.
    pub fn edge(&mut self, ring: Ring) -> Ring {
        let first = ring.first as usize;
        let (owner, v) = (self.owners[first], self.uvs[first].y);
        let last = first + self.around as usize;
        let places = self.positions[first..last].to_vec();
        self.ring(owner, v, |k| places[k as usize])
    }

    /// The place of the k-th vertex.
    pub fn place(&self, ring: Ring, k: u32) -> DVec3 {
        self.positions[(ring.first + k) as usize]
    }

    /// Lets a ring move with another segment as well.
    pub fn share(&mut self, ring: Ring, neighbour: usize) {
        for vertex in ring.first..=ring.first + self.around {
            self.owners[vertex as usize].neighbour = neighbour as u32;
        }
    }

    fn vertex(&mut self, position: DVec3, uv: DVec2, owner: Owner, group: u32) -> u32 {
        self.positions.push(position);
        self.uvs.push(uv);
        self.owners.push(owner);
        self.groups.push(group);
        self.positions.len() as u32 - 1
    }

    /// Two triangles for each quad between a ring and the next one along the limb. Of a quad's diagonals the shorter
    /// is drawn: it lies nearer a curved surface.
    pub fn strip(&mut self, low: Ring, high: Ring) {
        for k in 0..self.around {
            let (a, b) = (low.first + k, low.first + k + 1);
            let (c, d) = (high.first + k, high.first + k + 1);
            let at = |vertex: u32| self.positions[vertex as usize];
            let (ad, bc) = (at(a).distance_squared(at(d)), at(b).distance_squared(at(c)));
            // Rounding shall not choose where both are alike.
            if ad < bc * (1.0 - 1e-9) {
                self.triangles.extend([[a, b, d], [a, d, c]]);
            } else {
                self.triangles.extend([[a, b, c], [b, d, c]]);
            }
        }
    }

    /// A fan from a ring to a pole, which lies after it along the limb, or before it.
    pub fn fan(&mut self, ring: Ring, pole: DVec3, after: bool) {
        let owner = self.owners[ring.first as usize];
        let v = self.uvs[ring.first as usize].y;
        let group = self.group_count;
        self.group_count += 1;
        for k in 0..self.around {
            let uv = DVec2::new((f64::from(k) + 0.5) / f64::from(self.around), v);
            let tip = self.vertex(pole, uv, owner, group);
            let (a, b) = (ring.first + k, ring.first + k + 1);
            self.triangles
                .push(if after { [a, b, tip] } else { [b, a, tip] });
        }
    }

    /// Rings of a strip that bulges about `center`; where it is turned inside out, hidden by what it joins, it shall
    /// not count for normals.
    pub fn bridge(&mut self, rings: &[Ring], center: DVec3) {
        let from = self.triangles.len();
        for pair in rings.windows(2) {
            self.strip(pair[0], pair[1]);
        }
        self.bulges.push(Bulge {
            triangles: from..self.triangles.len(),
            center,
        });
    }

    /// The mesh, of which so many triangles are segments' grids.
    pub fn finish(self, grid_triangles: usize) -> MeshParts {
        let group_normals = smooth_normals(
            &self.positions,
            &self.groups,
            self.group_count as usize,
            &self.triangles,
            &self.bulges,
        );
        let single = |p: &DVec3| p.as_vec3().to_array();
        MeshParts {
            positions: self.positions.iter().map(single).collect(),
            normals: self
                .groups
                .iter()
                .map(|&group| single(&group_normals[group as usize]))
                .collect(),
            uvs: self.uvs.iter().map(|uv| uv.as_vec2().to_array()).collect(),
            extra_triangles: self.triangles.len() - grid_triangles,
            indices: self.triangles.into_iter().flatten().collect(),
            segments: self.owners.iter().map(|owner| owner.segment).collect(),
            neighbours: self.owners.iter().map(|owner| owner.neighbour).collect(),
        }
    }
}
