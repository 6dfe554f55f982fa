//! Error against the bend of height vectors, up to where they cross.

use bevy::mesh::VertexAttributeValues;
use bevy::prelude::*;
use bevy_verdure::lab::charts::{Axis, Chart, Point, Series};
use bevy_verdure::lab::texel_scenes::Pattern;
use bevy_verdure::lab::texel_scenes::surfaces::{grid, with_heights};
use bevy_verdure::lab::{Lens, Shot, Studio, adapter_name, mean_flip};
use bevy_verdure::prelude::*;
use bevy_verdure::texel::ReferenceVolume;
use bevy_verdure::texel::build::Spreading;
use bevy_verdure::texel::silent;

use super::field::BACKGROUND;
use super::lab::Lab;
use super::march::Marched;

/// How height vectors of a square bend.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Bend {
    /// All lean to one side.
    Lean,
    /// The top is larger than the ground.
    Apart,
    /// The top is smaller, and a point in the end.
    Together,
    /// The top is turned, on a square of so many facets along each side.
    Twist(u32),
}

impl Bend {
    const fn name(self) -> &'static str {
        match self {
            Self::Lean => "all lean",
            Self::Apart => "apart",
            Self::Together => "together",
            Self::Twist(1) => "twist",
            Self::Twist(_) => "twist, 16 times the facets",
        }
    }

    /// The height vector of a place on the ground, if those of opposite corners are so many degrees apart; of those that
    /// lean, so many from upright.
    fn height(self, at: Vec3, degrees: f32) -> Vec3 {
        let half = (0.5 * degrees).to_radians().tan();
        let out = Vec3::new(at.x, 0.0, at.z);
        // Of a corner.
        let reach = 0.5 * 2f32.sqrt();
        match self {
            Self::Lean => {
                let (sin, cos) = degrees.to_radians().sin_cos();
                Vec3::new(0.8 * sin, cos, -0.6 * sin)
            }
            Self::Apart => Vec3::Y + out * (half / reach),
            Self::Together => Vec3::Y - out * (half / reach),
            Self::Twist(_) => {
                // The top moves aside by 2·reach·sin(turn/2).
                let turn = 2.0 * (0.5 * half / reach).min(1.0).asin();
                Vec3::Y + Quat::from_rotation_y(turn) * out - out
            }
        }
    }

    fn mesh(self, degrees: f32) -> Mesh {
        let parts = if let Self::Twist(parts) = self {
            parts
        } else {
            1
        };
        let mut mesh = grid(parts, parts, Vec2::ONE);
        // One texel in all.
        if let Some(VertexAttributeValues::Float32x2(uvs)) =
            mesh.attribute_mut(Mesh::ATTRIBUTE_UV_0)
        {
            for uv in uvs {
                *uv = uv.map(|value| value / parts as f32);
            }
        }
        with_heights(mesh, |at| self.height(at, degrees))
    }
}

/// Eyes aslant and grazing.
fn shots(size: UVec2) -> [Shot; 2] {
    [Vec3::new(1.2, 2.3, 2.2), Vec3::new(2.7, 0.9, 1.6)].map(|eye| Shot {
        eye,
        at: Vec3::Y * 0.5,
        lens: Lens::Perspective(0.55),
        size,
    })
}

/// The chart.
pub fn against_angle(lab: &Lab) -> Result<Chart, String> {
    let built = Pattern::Pear.build(UVec3::splat(64), Spreading::default(), &silent);
    let volume = built.map_err(|error| error.to_string())?.volume;
    let mut studio = Studio::default();
    let handle = studio
        .world()
        .resource_mut::<Assets<TexelVolume>>()
        .add(TexelVolume::from(volume.clone()));
    let step = if lab.quick { 40 } else { 20 };
    let mut series = Vec::new();
    let bends = [
        Bend::Lean,
        Bend::Apart,
        Bend::Together,
        Bend::Twist(1),
        Bend::Twist(4),
    ];
    for bend in bends {
        let mut points = Vec::new();
        for degrees in (0..=110).step_by(step).map(|degrees| degrees as f32) {
            if bend == Bend::Lean && degrees > 80.0 {
                break;
            }
            let surface = TexelSurface {
                volume: handle.clone(),
                ..default()
            };
            let mesh = bend.mesh(degrees);
            let found = surface.facets(&mesh).map_err(|error| error.to_string())?;
            if !found.left_out.is_empty() {
                println!("{} {degrees}: {:?}", bend.name(), found.left_out[0]);
                if let Some(last) = points.pop() {
                    let last: Point = last;
                    points.push(last.labelled(format!("crossed at {degrees}")));
                }
                break;
            }
            let error = error(lab, &mut studio, &volume, surface, mesh, bend)?;
            println!("{} {degrees}: {error:.4}", bend.name());
            points.push((f64::from(degrees), error).into());
        }
        series.push(Series::line(bend.name(), points));
    }
    Ok(Chart {
        title: "Error against the bend of height vectors, a pear".into(),
        subtitle: adapter_name(studio.world()),
        x: Axis::linear("angle between height vectors of opposite corners (degrees)"),
        y: Axis::linear("mean FLIP against rays marched in f64"),
        series,
    })
}

/// Mean FLIP over the shots, unlit.
fn error(
    lab: &Lab,
    studio: &mut Studio,
    volume: &ReferenceVolume,
    surface: TexelSurface,
    mesh: Mesh,
    bend: Bend,
) -> Result<f64, String> {
    let facets = surface.facets(&mesh).map_err(|error| error.to_string())?;
    let world = studio.world();
    let mesh = world.resource_mut::<Assets<Mesh>>().add(mesh);
    let settings = TexelSettings {
        lighting: PlantLighting::Unlit,
        ..default()
    };
    let covered = world.spawn((Mesh3d(mesh), surface, settings)).id();
    let shots = shots(lab.size / 4);
    let mut sum = 0.0;
    for (i, shot) in shots.iter().enumerate() {
        for _ in 0..2 {
            studio.headless.step();
        }
        let picture = studio.photograph(shot, BACKGROUND).rgb_bytes();
        let reference = Marched::new(volume, &facets.facets, shot, 1).unlit(BACKGROUND);
        let size = (shot.size.x, shot.size.y);
        sum += f64::from(mean_flip(size, &reference, &picture));
        for (what, rgb) in [("drawn", &picture), ("marched", &reference)] {
            lab.keep(&format!("bend_{bend:?}_{i}_{what}"), shot.size, rgb)?;
        }
    }
    studio.world().despawn(covered);
    Ok(sum / shots.len() as f64)
}
