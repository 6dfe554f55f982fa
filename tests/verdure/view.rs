//! A view through any projection: its rays and its depths, from nothing but the matrix that the shaders are given.

use bevy::camera::RenderTarget;
use bevy::math::{DMat4, DVec2, DVec3};
use bevy::prelude::*;
use bevy::render::camera::TemporalJitter;
use bevy::render::render_resource::TextureFormat;
use bevy_verdure::lab::reference::ReferenceScene;
use bevy_verdure::lab::{Pixels, Studio};
use bevy_verdure::prelude::*;

/// Where a picture is taken from, and how.
#[derive(Clone)]
pub struct View {
    pub eye: Transform,
    pub projection: Projection,
    /// In pixels, as temporal anti-aliasing moves the picture.
    pub jitter: Option<Vec2>,
    /// Size of the picture in pixels.
    pub size: UVec2,
}

/// What a pixel sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sight {
    Nothing,
    Wall,
    /// The segment that ends at a joint, at a depth in metres.
    Segment(u32, f64),
}

/// What stands before a view: a plant, and perhaps an endless wall through a point, with a normal.
pub struct Scenery {
    pub plant: ReferenceScene,
    pub wall: Option<(DVec3, DVec3)>,
}

/// What the wall writes where plants write the segment.
const WALL: f32 = 1000.0;
/// Greatest error of depth, as a share of the distance.
const DEPTH: f64 = 1e-4;
/// Share of a pixel within which outlines are where the reference has them.
const OUTLINE: f32 = 0.05;

impl View {
    fn clip_from_view(&self) -> DMat4 {
        let size = self.size.as_vec2();
        let mut projection = self.projection.clone();
        projection.update(size.x, size.y);
        let mut clip_from_view = projection.get_clip_from_view();
        if let Some(offset) = self.jitter {
            TemporalJitter { offset }.jitter_projection(&mut clip_from_view, size);
        }
        clip_from_view.as_dmat4()
    }

    /// The ray through a point of the picture, in pixels, in world space; its direction is one metre of depth long.
    pub fn ray(&self, x: f32, y: f32) -> (DVec3, DVec3) {
        let clip_from_view = self.clip_from_view();
        let ndc = 2.0 * DVec2::new(x.into(), y.into()) / self.size.as_dvec2() - 1.0;
        let rows = [0, 1, 3].map(|i| clip_from_view.row(i));
        // A point at a depth lies on the ray if clip.x = ndc.x · clip.w, and as much for y: two lines in x and y.
        let [a, b] = [rows[0] - ndc.x * rows[2], rows[1] + ndc.y * rows[2]];
        let at_depth = |depth: f64| {
            let right = DVec2::new(a.z * depth - a.w, b.z * depth - b.w);
            let determinant = a.x * b.y - a.y * b.x;
            let x = (right.x * b.y - right.y * a.y) / determinant;
            let y = (a.x * right.y - b.x * right.x) / determinant;
            DVec3::new(x, y, -depth)
        };
        let turn = self.eye.rotation.as_dquat();
        let origin = at_depth(0.0);
        let direction = at_depth(1.0) - origin;
        (
            self.eye.translation.as_dvec3() + turn * origin,
            turn * direction,
        )
    }

    /// What the depth buffer holds for a point of the world: 1 on the near plane, 0 on the far plane.
    fn buffer_depth(&self, point: DVec3) -> f64 {
        let turn = self.eye.rotation.as_dquat().inverse();
        let point = turn * (point - self.eye.translation.as_dvec3());
        let clip = self.clip_from_view() * point.extend(1.0);
        clip.z / clip.w
    }

    /// What the reference sees through a point of the picture.
    fn expect(&self, scenery: &Scenery, x: f32, y: f32) -> Sight {
        let (origin, direction) = self.ray(x, y);
        let is_near = |t: f64| t <= 0.0 || self.buffer_depth(origin + direction * t) > 1.0;
        let is_far = |t: f64| self.buffer_depth(origin + direction * t) < 0.0;
        let mut past = 0.0;
        let plant = loop {
            match scenery.plant.cast(origin, direction, past) {
                Some(hit) if is_near(hit.t) => past = hit.t + 1e-9,
                hit => break hit.filter(|hit| !is_far(hit.t)),
            }
        };
        let wall = scenery
            .wall
            .map(|(point, normal)| (point - origin).dot(normal) / direction.dot(normal));
        match (plant, wall.filter(|t| !is_near(*t) && !is_far(*t))) {
            (Some(hit), wall) if wall.is_none_or(|t| hit.t < t) => {
                Sight::Segment(hit.segment as u32, hit.t)
            }
            (None, None) => Sight::Nothing,
            _ => Sight::Wall,
        }
    }

    /// Aims a studio's camera, and gives it an image of figures.
    pub fn aim(&self, studio: &mut Studio, size: UVec2) -> RenderTarget {
        let target = studio.headless.target(size, TextureFormat::Rgba32Float);
        studio.set_output(FrustaOutput::Geometry);
        let camera = studio.camera();
        let mut camera = studio.world().entity_mut(camera);
        let empty = LinearRgba::new(-1.0, -1.0, -1.0, -1.0);
        camera.insert((
            Camera {
                clear_color: ClearColorConfig::Custom(empty.into()),
                ..default()
            },
            target.clone(),
            self.eye,
            self.projection.clone(),
        ));
        if let Some(offset) = self.jitter {
            camera.insert(TemporalJitter { offset });
        }
        // What a material writes, and a camera's target, reach the pipelines a frame later.
        studio.headless.step();
        target
    }

    /// A picture of figures of what a studio holds.
    pub fn look(&self, studio: &mut Studio) -> Pixels {
        let target = self.aim(studio, self.size);
        studio.headless.capture(&target)
    }

    /// Checks that every pixel sees what the reference does through its middle, or hardly beside it. Gives back how
    /// many see the plant, and how many the wall.
    pub fn check(&self, picture: &Pixels, scenery: &Scenery) -> (usize, usize) {
        let (mut plant, mut wall) = (0, 0);
        for y in 0..self.size.y {
            for x in 0..self.size.x {
                let seen = sight(picture, x, y);
                let agrees = |dx: f32, dy: f32| {
                    let at = (x as f32 + 0.5 + dx, y as f32 + 0.5 + dy);
                    let distance = self.ray(at.0, at.1).1.length();
                    is_same(seen, self.expect(scenery, at.0, at.1), distance)
                };
                let beside = || {
                    let sides = [-OUTLINE, 0.0, OUTLINE];
                    sides
                        .iter()
                        .any(|dx| sides.iter().any(|dy| agrees(*dx, *dy)))
                };
                assert!(
                    agrees(0.0, 0.0) || beside(),
                    "{x},{y}: {seen:?} instead of {:?}",
                    self.expect(scenery, x as f32 + 0.5, y as f32 + 0.5)
                );
                plant += usize::from(matches!(seen, Sight::Segment(..)));
                wall += usize::from(seen == Sight::Wall);
            }
        }
        println!("{plant} pixels of the plant, {wall} of the wall");
        (plant, wall)
    }
}

/// What a pixel of a picture of figures sees.
pub fn sight(picture: &Pixels, x: u32, y: u32) -> Sight {
    let [depth, segment, ..] = picture.floats(x, y);
    if segment < 0.0 {
        Sight::Nothing
    } else if segment == WALL {
        Sight::Wall
    } else {
        Sight::Segment(segment as u32, depth.into())
    }
}

/// `distance` is the length of a ray a metre of depth long.
fn is_same(seen: Sight, expected: Sight, distance: f64) -> bool {
    match (seen, expected) {
        (Sight::Segment(a, t), Sight::Segment(b, u)) => {
            a == b && (t - u).abs() <= DEPTH * distance * u
        }
        (a, b) => a == b,
    }
}

/// Puts up a wall through a point, across a normal, that shows in pictures of figures.
pub fn put_up_wall(studio: &mut Studio, point: Vec3, normal: Vec3) -> (DVec3, DVec3) {
    let world = studio.world();
    // Far beyond what any view here sees.
    let mesh = Rectangle::new(400.0, 400.0);
    let mesh = world.resource_mut::<Assets<Mesh>>().add(mesh);
    let material = StandardMaterial {
        base_color: LinearRgba::rgb(WALL, WALL, WALL).into(),
        unlit: true,
        cull_mode: None,
        ..default()
    };
    let material = world
        .resource_mut::<Assets<StandardMaterial>>()
        .add(material);
    let turn = Quat::from_rotation_arc(Vec3::Z, normal);
    world.spawn((
        Mesh3d(mesh),
        MeshMaterial3d(material),
        Transform::from_translation(point).with_rotation(turn),
    ));
    (point.as_dvec3(), (turn * Vec3::Z).as_dvec3())
}
