//! Where it fails: crowns of blended slicings let through more or less of what is behind them than one slicing (§2.3).

use bevy::color::Luminance;
use bevy::prelude::*;
use bevy_verdure::lab::Shot;
use bevy_verdure::lab::charts::{Axis, Chart, Series};
use bevy_verdure::prelude::*;

use super::accuracy::{SKY, planted, shot, uproot};
use super::lab::{Drawn, Lab};

/// Metres from the crown's centroid to the eye.
const DISTANCE: f32 = 25.0;
/// Radius of the disc in which brightness is taken, as a share of half the picture's side: it lies within the crown.
const DISC: f32 = 0.5;

/// Mean luminance of the middle of a crown, in linear light, over some shots.
pub fn brightness(lab: &mut Lab, shots: &[Shot], background: Color) -> f64 {
    let (mut sum, mut count) = (0.0, 0_u32);
    for shot in shots {
        let picture = lab.studio.photograph(shot, background);
        let half = 0.5 * shot.size.as_vec2();
        for (x, y) in (0..shot.size.y).flat_map(|y| (0..shot.size.x).map(move |x| (x, y))) {
            let place = UVec2::new(x, y).as_vec2() + 0.5 - half;
            if place.length() > DISC * half.x {
                continue;
            }
            let [r, g, b] = picture.rgb(x, y);
            sum += f64::from(Color::srgb_u8(r, g, b).to_linear().luminance());
            count += 1;
        }
    }
    sum / f64::from(count)
}

/// Eyes all round, so many degrees off an orientation.
pub fn eyes(lab: &Lab, distance: f32, angle: f32) -> Vec<Shot> {
    let step = if lab.quick { 2 } else { 1 };
    (0..6)
        .step_by(step)
        .map(|i| shot(lab, distance, 60.0 * i as f32 + angle, 0.0))
        .collect()
}

/// Brightness before black, the sky and white, less the mesh's: what is behind shows through in proportion, so that lines
/// are straight, rise where too much does, and begin below 0 where the crown itself is too dark.
pub fn against_background(lab: &mut Lab) -> Result<Chart, String> {
    let paper = CrownSettings {
        order: SliceOrder::Paper,
        ..default()
    };
    let bake = BakeSettings::default();
    let slicing = lab.bake(&bake)?;
    let uncorrected = lab.bake(&BakeSettings {
        correction: 0.0,
        ..bake
    })?;
    let sliced = |slicing: Handle<Slicing>, settings| Drawn::Slicing(slicing, settings);
    let ways = [
        ("mesh", Drawn::Mesh),
        ("default", sliced(slicing.clone(), default())),
        ("paper, m_s = 0.5", sliced(slicing, paper)),
        ("paper, m_s = 0", sliced(uncorrected, paper)),
    ];
    let backgrounds = [Color::BLACK, SKY, Color::WHITE];
    let camera = lab.studio.camera();
    lab.studio.world().entity_mut(camera).insert(Msaa::Sample4);
    let mut of_mesh = Vec::new();
    let mut series = Vec::new();
    for (name, drawn) in ways {
        let tree = planted(lab, &drawn, &[Transform::IDENTITY]);
        for (i, angle) in [0.0, 30.0].into_iter().enumerate() {
            let shots = eyes(lab, DISTANCE, angle);
            let seen = backgrounds.map(|background| brightness(lab, &shots, background));
            println!("{name}, {angle} degrees: {seen:.4?}");
            let Some(mesh) = of_mesh.get(i) else {
                of_mesh.push(seen);
                continue;
            };
            let points = [0, 1, 2].map(|k| {
                let behind = backgrounds[k].to_linear().luminance();
                (f64::from(behind), seen[k] - mesh[k])
            });
            series.push(Series::line(format!("{name}, {angle} degrees"), points));
        }
        uproot(lab, &tree);
    }
    lab.studio.world().entity_mut(camera).insert(Msaa::Off);
    Ok(Chart {
        title: "Brightness before black, sky and white, 25 m away, by discrepancy angle".into(),
        subtitle: lab.adapter.clone(),
        x: Axis::linear("luminance of what is behind (1 is white)"),
        y: Axis::linear("mean luminance of the crown less the mesh's"),
        series,
    })
}
