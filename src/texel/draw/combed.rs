//! What brushes have made of a surface: height vectors, changed in frames in which a brush moves or they rise again.

use bevy::ecs::change_detection::Tick;
use bevy::ecs::entity::EntityHashMap;
use bevy::ecs::system::SystemParam;
use bevy::math::{Affine3A, Vec3A};
use bevy::platform::collections::{HashMap, HashSet};
use bevy::prelude::*;

use super::super::facet::{Facet, Surface};
use super::brush::{Stroke, StrokedTexels, TexelBrush};
use super::component::{LiveTexels, TexelHeights, TexelSurface};
use super::geometry::completed;

/// What brushes have made of a surface. On the surface, once a brush has moved near it.
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
    /// When those were last written, as far as is known here. Unlike what a system has seen, it tells of what was written
    /// while the surface was left out.
    looked: Option<Tick>,
}

/// A mesh with texels as thick.
#[derive(Clone, Copy, PartialEq)]
struct Source {
    mesh: AssetId<Mesh>,
    /// Bits of the thickness.
    thickness: u32,
    vertices: usize,
}

/// A sphere that holds the vertices of a mesh, in its space.
#[derive(Clone, Copy)]
struct Sphere {
    centre: Vec3,
    radius: f32,
}

/// How much larger spheres are taken to be, as what is compared with them rounds.
const ROUNDING: f32 = 1e-6;

impl Sphere {
    /// None of a mesh without vertices.
    fn new(mesh: &Mesh) -> Option<Self> {
        let positions = mesh.try_attribute(Mesh::ATTRIBUTE_POSITION).ok()?;
        let positions = positions.as_float3()?;
        // No brush reaches a vertex that is nowhere.
        let all = || {
            let all = positions.iter().copied().map(Vec3::from);
            all.filter(|at| at.is_finite())
        };
        let centre = all().reduce(Vec3::min)?.midpoint(all().reduce(Vec3::max)?);
        let radius = all().map(|at| at.distance(centre)).fold(0.0, f32::max);
        Some(Self { centre, radius })
    }

    /// Whether a brush that moves may reach what is in it.
    fn is_near(&self, place: &Place, strokes: &[Stroke]) -> bool {
        let axes = place.world_from_local.matrix3;
        let axes = [axes.x_axis, axes.y_axis, axes.z_axis];
        // Nothing is stretched more.
        let stretch = axes.map(Vec3A::length_squared);
        let stretch = stretch.iter().sum::<f32>().sqrt();
        let far = place.world_from_local.translation.length()
            + (self.centre.length() + self.radius) * stretch;
        let centre = place.world_from_local.transform_point3(self.centre);
        let radius = self.radius * stretch + far * ROUNDING;
        let mut moving = strokes.iter().filter(|stroke| stroke.moves());
        moving.any(|stroke| stroke.comes_near(centre, radius))
    }
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
            Some(heights) => {
                self.looked != Some(heights.last_changed()) && !are_same(&heights.0, &self.heights)
            }
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

    /// Lets what is combed rise by an angle, but for what is held at its place in the mesh's space. Tells whether anything
    /// has moved.
    fn rise(&mut self, angle: f32, is_held: impl Fn(Vec3) -> bool) -> bool {
        let mut risen: Option<Vec<Vec3>> = None;
        let mut holds = false;
        self.is_combed = false;
        let rest = self.rest.positions.iter().zip(&self.rest.heights);
        for (vertex, (&height, (&at, &rest))) in self.heights.iter().zip(rest).enumerate() {
            // What is no number is not combed.
            if height == rest || !height.is_finite() {
                continue;
            }
            self.is_combed = true;
            if is_held(at) {
                holds = true;
                continue;
            }
            let risen = risen.get_or_insert_with(|| self.heights.clone());
            risen[vertex] = nearer(height, rest, angle);
        }
        let Some(mut risen) = risen else {
            return false;
        };
        // Beside what is held down facets might be lost. All that rises comes to where none is in the end, and must not be
        // stuck on its way.
        if holds {
            keep_facets(&self.rest, &self.heights, &mut risen);
        }
        if are_same(&risen, &self.heights) {
            return false;
        }
        self.heights = risen;
        true
    }

    /// Strokes what is in reach of a brush that moves. Tells whether anything has moved.
    fn stroke(&mut self, place: &Place, strokes: &[Stroke]) -> bool {
        let mut stroked: Option<Vec<Vec3>> = None;
        for (vertex, &at) in self.rest.positions.iter().enumerate() {
            let at = place.world_from_local.transform_point3(at);
            let is_stroked = |stroke: &Stroke| stroke.moves() && stroke.reaches(at);
            if !strokes.iter().any(is_stroked) {
                continue;
            }
            // A plane's normal is across what lies in it, in a stretched space too.
            let normal = place.local_from_world.matrix3.transpose() * self.rest.normals[vertex];
            let normal = normal.normalize_or_zero();
            let upright = place
                .world_from_local
                .transform_vector3(self.heights[vertex]);
            let combed = strokes
                .iter()
                .fold(upright, |height, stroke| stroke.comb(at, normal, height));
            // Not there and back, which rounds.
            if combed == upright || !combed.is_finite() {
                continue;
            }
            let stroked = stroked.get_or_insert_with(|| self.heights.clone());
            stroked[vertex] = place.local_from_world.transform_vector3(combed);
        }
        let Some(mut stroked) = stroked else {
            return false;
        };
        keep_facets(&self.rest, &self.heights, &mut stroked);
        if are_same(&stroked, &self.heights) {
            return false;
        }
        self.heights = stroked;
        self.is_combed = true;
        true
    }
}

/// The angle to rest below which what rises may be there but for rounding.
const LEAST_ANGLE: f32 = 1e-3;

/// A height vector, nearer to rest by an angle.
fn nearer(height: Vec3, rest: Vec3, angle: f32) -> Vec3 {
    let left = height.angle_between(rest);
    // What has come as near as rounding lets it would never be there.
    let comes_nearer = |risen: Vec3| {
        left >= LEAST_ANGLE || risen.distance_squared(rest) < height.distance_squared(rest)
    };
    if left > angle {
        let risen = height.slerp(rest, angle / left);
        if comes_nearer(risen) {
            return risen;
        }
    }
    rest
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
#[derive(SystemParam)]
pub(crate) struct Brushes<'w, 's> {
    brushes: Query<'w, 's, (Entity, &'static TexelBrush)>,
    /// Where they are.
    places: Local<'s, EntityHashMap<Vec3>>,
    /// Where they were in the frame before.
    before: Local<'s, EntityHashMap<Vec3>>,
    strokes: Local<'s, Vec<Stroke>>,
}

impl Brushes<'_, '_> {
    /// Their ways in this frame.
    fn strokes(&mut self, transforms: &TransformHelper) -> &[Stroke] {
        core::mem::swap(&mut *self.before, &mut *self.places);
        self.places.clear();
        self.strokes.clear();
        for (entity, brush) in &self.brushes {
            let Ok(transform) = transforms.compute_global_transform(entity) else {
                continue;
            };
            let to = transform.translation();
            if to.is_finite() {
                let from = self.before.get(&entity).copied().unwrap_or(to);
                self.places.insert(entity, to);
                self.strokes.extend(Stroke::new(brush, from, to));
            }
        }
        self.strokes.as_slice()
    }
}

/// The meshes of surfaces.
#[derive(SystemParam)]
pub(crate) struct StrokedMeshes<'w, 's> {
    meshes: Res<'w, Assets<Mesh>>,
    events: MessageReader<'w, 's, AssetEvent<Mesh>>,
    /// Those that have been edited since the frame before.
    edited: Local<'s, HashSet<AssetId<Mesh>>>,
    /// Where their vertices are, of those that brushes have moved by.
    spheres: Local<'s, HashMap<AssetId<Mesh>, Option<Sphere>>>,
}

impl StrokedMeshes<'_, '_> {
    /// Takes note of edits.
    fn follow(&mut self) {
        self.edited.clear();
        for event in self.events.read() {
            match event {
                AssetEvent::Added { id } | AssetEvent::Modified { id } => {
                    self.edited.insert(*id);
                    self.spheres.remove(id);
                }
                AssetEvent::Removed { id } | AssetEvent::Unused { id } => {
                    self.spheres.remove(id);
                }
                AssetEvent::LoadedWithDependencies { .. } => {}
            }
        }
    }

    /// Where the vertices of a mesh are.
    fn sphere(&mut self, id: AssetId<Mesh>, is_live: bool) -> Option<Sphere> {
        let mesh = self.meshes.get(id)?;
        if is_live {
            return Sphere::new(mesh);
        }
        let sphere = self.spheres.entry(id);
        *sphere.or_insert_with(|| Sphere::new(mesh))
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

/// Lets brushes stroke surfaces. Both are where their transforms say in this frame, which are propagated only after height
/// vectors are attached.
pub(crate) fn stroke(
    mut commands: Commands,
    time: Res<Time>,
    mut meshes: StrokedMeshes,
    transforms: TransformHelper,
    mut brushes: Brushes,
    mut surfaces: Query<Strokable>,
) {
    let strokes = brushes.strokes(&transforms);
    let moves = strokes.iter().any(Stroke::moves);
    meshes.follow();
    for (entity, surface, mesh, stroked, is_live, mut heights, combed) in &mut surfaces {
        if combed.is_none() && !moves {
            continue;
        }
        let id = mesh.id();
        let angle = stroked.rise(time.delta_secs());
        let rises = angle > 0.0 && combed.as_ref().is_some_and(|combed| combed.is_combed);
        // Where nothing moves, it does not matter where a surface is.
        let place = (moves || rises).then(|| transforms.compute_global_transform(entity));
        let place = place.and_then(Result::ok);
        let place = place.and_then(|place| Place::new(place.affine()));
        let is_near = moves
            && place.is_some_and(|place| {
                let sphere = meshes.sphere(id, is_live);
                sphere.is_some_and(|sphere| sphere.is_near(&place, strokes))
            });
        let Some(mesh) = meshes.meshes.get(id) else {
            continue;
        };
        let mut fresh = None;
        let combed = match combed {
            Some(combed) => combed.into_inner(),
            None if is_near => fresh.insert(Combed::default()),
            None => continue,
        };
        if combed.is_overruled(heights.as_ref()) {
            *combed = Combed::default();
        }
        if combed.source.is_none() {
            if !is_near {
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
        // What is shown follows a live mesh in the same frame, at rest too.
        let is_edited = meshes.edited.contains(&id) || is_live && (is_near || heights.is_some());
        let is_read = combed.source != Some(source) || is_edited;
        if is_read {
            combed.read(source, mesh);
        }
        let is_held = |at: Vec3| {
            place.is_some_and(|place| {
                let at = place.world_from_local.transform_point3(at);
                strokes.iter().any(|stroke| stroke.reaches(at))
            })
        };
        let has_risen = combed.is_combed && angle > 0.0 && combed.rise(angle, is_held);
        let is_stroked = is_near && place.is_some_and(|place| combed.stroke(&place, strokes));
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
        combed.looked = heights.as_ref().map(|heights| heights.last_changed());
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

    /// A square of 0.1 m in two triangles, without height vectors.
    fn square() -> Surface {
        let corners = [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y];
        Surface {
            positions: corners.map(|corner| corner.extend(0.0) * 0.1).to_vec(),
            uvs: corners.to_vec(),
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            ..default()
        }
    }

    #[test]
    fn no_facet_is_lost_beside_what_is_held_down() {
        let up = vec![Vec3::Z; 4];
        let mut combed = Combed {
            rest: Surface {
                heights: vec![Vec3::new(0.6, 0.0, 0.8); 4],
                ..square()
            },
            heights: up.clone(),
            ..default()
        };
        // Alone it would cross the next one before it is at rest.
        for _ in 0..50 {
            combed.rise(0.05, |at| at != Vec3::ZERO);
            assert!(lost_facets(&combed.rest, &up, &combed.heights).is_empty());
        }
        assert_ne!(combed.heights[0], combed.rest.heights[0]);
        assert_eq!(&combed.heights[1..], &up[1..]);
        while combed.rise(0.05, |_| false) {}
        assert_eq!(combed.heights, combed.rest.heights);
    }

    #[test]
    fn what_is_nearly_at_rest_comes_to_rest() {
        let mut combed = lawn();
        let above = f32::from_bits(0.1f32.to_bits() + 1);
        combed.heights[0].y = above;
        combed.heights[1].x = 1e-8;
        combed.heights[2] = Vec3::new(-3e-8, above, 1e-8);
        let mut frames = 0;
        while combed.rise(1e-5, |_| false) {
            frames += 1;
            assert!(frames < 1000, "{:?}", &combed.heights[..3]);
        }
        assert_eq!(combed.heights, combed.rest.heights);
    }

    #[test]
    fn spheres_hold_their_vertices_and_brushes_pass_by() {
        let mesh = Plane3d::default().mesh().build();
        let sphere = Sphere::new(&mesh).expect("it has vertices");
        let place = Affine3A::from_scale_rotation_translation(
            Vec3::new(3.0, 0.5, 2.0),
            Quat::from_rotation_y(0.7),
            Vec3::new(4.0, 5.0, 6.0),
        );
        let place = Place::new(place).expect("it can be undone");
        let brush = TexelBrush {
            radius: 0.01,
            ..default()
        };
        let near = |at: Vec3, to: Vec3| {
            let stroke = Stroke::new(&brush, at, to).expect("it reaches something");
            sphere.is_near(&place, &[stroke])
        };
        for corner in [Vec3::new(0.5, 0.0, 0.5), Vec3::new(-0.5, 0.0, 0.5)] {
            let corner = place.world_from_local.transform_point3(corner);
            assert!(near(corner, corner + Vec3::Y));
            assert!(!near(corner, corner), "it stands still");
        }
        assert!(!near(Vec3::ZERO, Vec3::X));
    }

    #[test]
    fn no_facet_is_lost() {
        let square = square();
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
