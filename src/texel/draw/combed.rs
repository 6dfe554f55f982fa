//! What brushes have made of a surface: height vectors, changed in frames in which a brush moves or they rise again.

use bevy::ecs::entity::EntityHashMap;
use bevy::math::Affine3A;
use bevy::platform::collections::HashSet;
use bevy::prelude::*;

use super::super::facet::{Facet, Surface};
use super::brush::{Stroke, StrokedTexels, TexelBrush};
use super::component::{LiveTexels, TexelHeights, TexelSurface};
use super::geometry::completed;

/// What brushes have made of a surface. On the surface, once a brush has moved anywhere.
#[derive(Component, Default)]
pub(crate) struct Combed {
    /// What `rest` was read from; none if it is still to be read.
    source: Option<Source>,
    /// The height vectors at rest, if the entity had some of its own.
    own: Option<TexelHeights>,
    /// The surface at rest, in the mesh's space; without vertices if it carries no texels.
    rest: Surface,
    /// The height vectors as they are combed.
    heights: Vec<Vec3>,
    /// Whether any of them may not be at rest.
    is_combed: bool,
    /// Whether the entity has height vectors, these or its own.
    is_shown: bool,
}

/// A mesh with texels as thick.
#[derive(Clone, Copy, PartialEq)]
struct Source {
    mesh: AssetId<Mesh>,
    /// Bits of the thickness.
    thickness: u32,
    vertices: usize,
}

/// Where a surface is.
#[derive(Clone, Copy)]
struct Place {
    world_from_local: Affine3A,
    local_from_world: Affine3A,
}

impl Place {
    /// None where nothing can be taken back into the surface's space.
    fn new(world_from_local: Affine3A) -> Option<Self> {
        let local_from_world = world_from_local.inverse();
        let is_good = world_from_local.is_finite() && local_from_world.is_finite();
        is_good.then_some(Self {
            world_from_local,
            local_from_world,
        })
    }
}

impl Combed {
    /// Whether something else has given the entity other height vectors, or taken away those that it had.
    fn is_overruled(&self, heights: Option<&Mut<TexelHeights>>) -> bool {
        match heights {
            Some(heights) => heights.is_changed() && !are_same(&heights.0, &self.heights),
            None => self.is_shown,
        }
    }

    /// Reads the surface at rest. What is combed goes along with it, if there are as many vertices as before.
    fn read(&mut self, source: Source, mesh: &Mesh) {
        self.source = Some(source);
        let thickness = f32::from_bits(source.thickness);
        // What carries no texels has nothing to stroke, and `attach` tells why.
        let read = completed(mesh, thickness, self.own.as_ref()).unwrap_or_default();
        let before = core::mem::replace(&mut self.rest, read).heights;
        let after = &self.rest.heights;
        if before.len() == after.len() {
            for (combed, (before, after)) in self.heights.iter_mut().zip(before.iter().zip(after)) {
                *combed = carried(*combed, *before, *after);
            }
        } else {
            self.heights.clone_from(after);
            self.is_combed = false;
        }
    }

    /// Lets what is combed rise by an angle, but for what is held at its place in the mesh's space. Tells whether anything has
    /// moved.
    fn rise(&mut self, angle: f32, is_held: impl Fn(Vec3) -> bool) -> bool {
        let mut has_moved = false;
        self.is_combed = false;
        let rest = self.rest.positions.iter().zip(&self.rest.heights);
        for (height, (&at, &rest)) in self.heights.iter_mut().zip(rest) {
            // What is no number is not combed.
            if *height == rest || !height.is_finite() {
                continue;
            }
            self.is_combed = true;
            if !is_held(at) {
                let left = height.angle_between(rest);
                *height = if left > angle {
                    height.slerp(rest, angle / left)
                } else {
                    rest
                };
                has_moved = true;
            }
        }
        has_moved
    }

    /// Strokes what is in reach. Tells whether anything may have moved.
    fn stroke(&mut self, place: &Place, strokes: &[Stroke]) -> bool {
        let mut stroked: Option<Vec<Vec3>> = None;
        for (vertex, &at) in self.rest.positions.iter().enumerate() {
            let at = place.world_from_local.transform_point3(at);
            if !strokes.iter().any(|stroke| stroke.reaches(at)) {
                continue;
            }
            // A plane's normal is across what lies in it, in a stretched space too.
            let normal = place.local_from_world.matrix3.transpose() * self.rest.normals[vertex];
            let normal = normal.normalize_or_zero();
            let height = self.heights[vertex];
            let height = strokes.iter().fold(
                place.world_from_local.transform_vector3(height),
                |height, stroke| stroke.comb(at, normal, height),
            );
            let stroked = stroked.get_or_insert_with(|| self.heights.clone());
            stroked[vertex] = place.local_from_world.transform_vector3(height);
        }
        let Some(mut stroked) = stroked else {
            return false;
        };
        keep_facets(&self.rest, &self.heights, &mut stroked);
        self.heights = stroked;
        self.is_combed = true;
        true
    }
}

/// A combed height vector, turned and stretched as the one at rest is.
fn carried(combed: Vec3, before: Vec3, after: Vec3) -> Vec3 {
    if before == after {
        return combed;
    }
    match (before.try_normalize(), after.try_normalize()) {
        (Some(from), Some(to)) if combed != before => {
            Quat::from_rotation_arc(from, to) * combed * (after.length() / before.length())
        }
        _ => after,
    }
}

/// Rounds in which what cannot be combed so far is combed half as far, before it stays where it was.
const HALVINGS: usize = 3;

/// Rounds after which nothing is combed, rather than that facets are lost.
const ROUNDS: usize = 12;

/// Combs height vectors less far from where they were, where a facet would lose its texels.
fn keep_facets(surface: &Surface, before: &[Vec3], after: &mut [Vec3]) {
    for round in 0..ROUNDS {
        let mut lost = lost_facets(surface, before, after);
        if lost.is_empty() {
            return;
        }
        lost.sort_unstable();
        lost.dedup();
        for vertex in lost {
            after[vertex] = if round < HALVINGS {
                before[vertex].slerp(after[vertex], 0.5)
            } else {
                before[vertex]
            };
        }
    }
    after.copy_from_slice(before);
}

/// Vertices of all facets that carried texels before, and would not after.
fn lost_facets(surface: &Surface, before: &[Vec3], after: &[Vec3]) -> Vec<usize> {
    let triangles = surface.triangles.iter();
    let triangles = triangles.map(|triangle| triangle.map(|vertex| vertex as usize));
    let is_lost = |vertices: &[usize; 3]| {
        let carries = |heights: &[Vec3]| {
            let facet = Facet {
                positions: vertices.map(|vertex| surface.positions[vertex]),
                heights: vertices.map(|vertex| heights[vertex]),
                uvs: vertices.map(|vertex| surface.uvs[vertex]),
            };
            facet.check().is_ok()
        };
        let has_moved = vertices
            .iter()
            .any(|&vertex| before[vertex] != after[vertex]);
        has_moved && carries(before) && !carries(after)
    };
    triangles.filter(is_lost).flatten().collect()
}

/// Whether height vectors are the same, what is no number too.
fn are_same(a: &[Vec3], b: &[Vec3]) -> bool {
    let bits = |height: &Vec3| height.to_array().map(f32::to_bits);
    a.len() == b.len() && a.iter().map(bits).eq(b.iter().map(bits))
}

/// The brushes of a scene.
#[derive(bevy::ecs::system::SystemParam)]
pub(crate) struct Brushes<'w, 's> {
    brushes: Query<'w, 's, (Entity, &'static TexelBrush)>,
    /// Where they were in the frame before.
    places: Local<'s, EntityHashMap<Vec3>>,
}

impl Brushes<'_, '_> {
    /// Their ways in this frame.
    fn strokes(&mut self, transforms: &TransformHelper) -> Vec<Stroke> {
        let before = core::mem::take(&mut *self.places);
        let mut strokes = Vec::new();
        for (entity, brush) in &self.brushes {
            let Ok(transform) = transforms.compute_global_transform(entity) else {
                continue;
            };
            let to = transform.translation();
            if to.is_finite() {
                let from = before.get(&entity).copied().unwrap_or(to);
                self.places.insert(entity, to);
                strokes.extend(Stroke::new(brush, from, to));
            }
        }
        strokes
    }
}

/// A surface that may be stroked.
type Strokable<'w> = (
    Entity,
    &'w TexelSurface,
    &'w Mesh3d,
    &'w StrokedTexels,
    Has<LiveTexels>,
    Option<&'w mut TexelHeights>,
    Option<&'w mut Combed>,
);

/// Lets brushes stroke surfaces. Both are where their transforms say in this frame, which are propagated only after height vectors
/// are attached.
pub(crate) fn stroke(
    mut commands: Commands,
    time: Res<Time>,
    meshes: Res<Assets<Mesh>>,
    mut edits: MessageReader<AssetEvent<Mesh>>,
    transforms: TransformHelper,
    mut brushes: Brushes,
    mut surfaces: Query<Strokable>,
) {
    let strokes = brushes.strokes(&transforms);
    let moves = strokes.iter().any(Stroke::moves);
    let edited = edits.read().filter_map(|event| match event {
        AssetEvent::Modified { id } => Some(*id),
        _ => None,
    });
    let edited: HashSet<AssetId<Mesh>> = edited.collect();
    for (entity, surface, mesh, stroked, is_live, mut heights, combed) in &mut surfaces {
        let id = mesh.id();
        let Some(mesh) = meshes.get(id) else {
            continue;
        };
        let mut fresh = None;
        let combed = match combed {
            Some(combed) => combed.into_inner(),
            None if moves => fresh.insert(Combed::default()),
            None => continue,
        };
        if combed.is_overruled(heights.as_ref()) {
            *combed = Combed::default();
        }
        if combed.source.is_none() {
            if !moves {
                continue;
            }
            combed.own = heights.as_deref().cloned();
        }
        let positions = mesh.try_attribute(Mesh::ATTRIBUTE_POSITION);
        let source = Source {
            mesh: id,
            thickness: surface.thickness.to_bits(),
            vertices: positions.map_or(0, |positions| positions.len()),
        };
        let is_edited = edited.contains(&id) || is_live && (moves || combed.is_combed);
        let is_read = combed.source != Some(source) || is_edited;
        if is_read {
            combed.read(source, mesh);
        }
        let place = transforms.compute_global_transform(entity);
        let place = place.ok().and_then(|place| Place::new(place.affine()));
        let is_held = |at: Vec3| {
            place.is_some_and(|place| {
                let at = place.world_from_local.transform_point3(at);
                strokes.iter().any(|stroke| stroke.reaches(at))
            })
        };
        let angle = stroked.rise(time.delta_secs());
        let has_risen = combed.is_combed && angle > 0.0 && combed.rise(angle, is_held);
        let is_stroked = moves && place.is_some_and(|place| combed.stroke(&place, &strokes));
        combed.is_shown = heights.is_some();
        // What has no vertices must not take the place of what the entity has.
        if (is_read || has_risen || is_stroked) && !combed.heights.is_empty() {
            match &mut heights {
                Some(shown) if are_same(&shown.0, &combed.heights) => {}
                Some(shown) => shown.0.clone_from(&combed.heights),
                None if combed.is_combed => {
                    let heights = TexelHeights(combed.heights.clone());
                    commands.entity(entity).try_insert(heights);
                    combed.is_shown = true;
                }
                None => {}
            }
        }
        if let Some(fresh) = fresh {
            commands.entity(entity).try_insert(fresh);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STILL: Place = Place {
        world_from_local: Affine3A::IDENTITY,
        local_from_world: Affine3A::IDENTITY,
    };

    /// A square metre of ground in 128 triangles, under texels 0.1 m tall.
    fn lawn() -> Combed {
        let mesh = Plane3d::default().mesh().subdivisions(7).build();
        let source = Source {
            mesh: AssetId::default(),
            thickness: 0.1f32.to_bits(),
            vertices: mesh.count_vertices(),
        };
        let mut combed = Combed::default();
        combed.read(source, &mesh);
        combed
    }

    fn strokes() -> Vec<Stroke> {
        let brush = TexelBrush {
            radius: 0.25,
            ..default()
        };
        let across = Stroke::new(
            &brush,
            Vec3::new(-0.3, 0.0, -0.6),
            Vec3::new(-0.3, 0.0, 0.6),
        );
        across.into_iter().collect()
    }

    #[test]
    fn what_is_stroked_lies_down_and_rises_again() {
        let mut combed = lawn();
        assert!(combed.stroke(&STILL, &strokes()));
        let (mut near, mut far) = (0, 0);
        for (at, height) in combed.rest.positions.iter().zip(&combed.heights) {
            assert!((height.length() - 0.1).abs() < 1e-5);
            if at.x > -0.04 {
                assert_eq!(*height, Vec3::Y * 0.1, "{at}");
                far += 1;
            } else if (at.x + 0.3).abs() < 0.1 {
                assert!(height.z > 0.03 && height.y > 0.0, "{at} {height}");
                near += 1;
            }
        }
        assert!(near > 0 && far > 0);
        // What is held down stays, and all else is up in the end.
        assert!(!combed.rise(0.1, |_| true) && combed.is_combed);
        let mut frames = 0;
        while combed.rise(0.1, |_| false) {
            frames += 1;
        }
        assert!((8..16).contains(&frames), "{frames}");
        assert!(!combed.is_combed && combed.heights == combed.rest.heights);
    }

    #[test]
    fn what_is_stroked_in_a_space_is_stroked_in_all() {
        let place = Affine3A::from_scale_rotation_translation(
            Vec3::new(3.0, -0.5, 2.0),
            Quat::from_rotation_y(0.7),
            Vec3::new(4.0, 5.0, 6.0),
        );
        let place = Place::new(place).expect("it can be undone");
        let (mut flat, mut stretched) = (lawn(), lawn());
        // The same ground from another space.
        stretched.rest.positions = (flat.rest.positions.iter())
            .map(|&at| place.local_from_world.transform_point3(at))
            .collect();
        stretched.heights = (flat.heights.iter())
            .map(|&height| place.local_from_world.transform_vector3(height))
            .collect();
        for normal in &mut stretched.rest.normals {
            *normal = -*normal;
        }
        stretched.rest.triangles.clear();
        flat.rest.triangles.clear();
        flat.stroke(&STILL, &strokes());
        stretched.stroke(&place, &strokes());
        for (flat, stretched) in flat.heights.iter().zip(&stretched.heights) {
            let stretched = place.world_from_local.transform_vector3(*stretched);
            assert!(flat.distance(stretched) < 1e-5, "{flat} {stretched}");
        }
        assert!(Place::new(Affine3A::from_scale(Vec3::new(1.0, 0.0, 1.0))).is_none());
    }

    #[test]
    fn no_facet_is_lost() {
        let corners = [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y];
        let square = Surface {
            positions: corners.map(|corner| corner.extend(0.0) * 0.1).to_vec(),
            uvs: corners.to_vec(),
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            ..default()
        };
        let up = vec![Vec3::Z; 4];
        // Six times as far aside as the next one stands.
        let mut combed = up.clone();
        combed[0] = Vec3::new(0.6, 0.0, 0.8);
        assert_eq!(lost_facets(&square, &up, &combed), [0, 1, 2]);
        keep_facets(&square, &up, &mut combed);
        assert!(lost_facets(&square, &up, &combed).is_empty());
        assert!(combed[0].x > 0.05, "{}", combed[0]);
        assert_eq!(&combed[1..], &up[1..]);
        // Through the surface.
        combed[0] = Vec3::new(0.0, 0.0, -1.0);
        keep_facets(&square, &up, &mut combed);
        assert!(lost_facets(&square, &up, &combed).is_empty());
    }

    #[test]
    fn what_is_combed_goes_along_with_a_mesh_that_moves() {
        let combed = Vec3::new(0.0, 0.6, 0.8);
        let turned = carried(combed, Vec3::Y, Vec3::X * 2.0);
        assert!(turned.distance(Vec3::new(1.2, 0.0, 1.6)) < 1e-5, "{turned}");
        assert_eq!(carried(combed, Vec3::Y, Vec3::Y), combed);
        assert_eq!(carried(Vec3::Y, Vec3::Y, Vec3::X), Vec3::X);
        assert_eq!(carried(combed, Vec3::ZERO, Vec3::X), Vec3::X);
    }

    #[test]
    fn what_is_no_number_is_the_same_as_itself() {
        let heights = [Vec3::NAN, Vec3::Y];
        assert!(are_same(&heights, &heights));
        assert!(!are_same(&heights, &heights[..1]));
    }
}
