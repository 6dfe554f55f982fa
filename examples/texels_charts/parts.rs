//! Where the time goes: the plane with one thing after the other left out.

use bevy::core_pipeline::prepass::DepthPrepass;
use bevy::light::NotShadowCaster;
use bevy::prelude::*;
use bevy_verdure::lab::charts::{Axis, Chart, Point, Series};
use bevy_verdure::lab::texel_scenes::TexelScene;
use bevy_verdure::lab::{Clock, Headless, Race, Variant};
use bevy_verdure::prelude::*;

use super::lab::Lab;

/// A way to draw the texels: its name, what lights them, whether they cast shadows, and have a depth prepass; none, if they
/// are hidden.
type Way = (&'static str, Option<(PlantLighting, [bool; 2])>);

const WAYS: [Way; 7] = [
    ("empty", None),
    ("all", Some((PlantLighting::Simple, [true, false]))),
    (
        "with a depth prepass",
        Some((PlantLighting::Simple, [true, true])),
    ),
    (
        "no shadows cast",
        Some((PlantLighting::Simple, [false, false])),
    ),
    ("full light", Some((PlantLighting::Full, [true, false]))),
    (
        "colours of the volume",
        Some((PlantLighting::Unlit, [true, false])),
    ),
    (
        "colours of the volume, no shadows cast",
        Some((PlantLighting::Unlit, [false, false])),
    ),
];

/// What each way takes.
pub fn time(lab: &Lab) -> Result<Chart, String> {
    let scene = TexelScene::Plane;
    let mut stand = lab.open(scene)?;
    stand.set(TexelSettings::default());
    stand.photograph(&lab.shot(scene, 1.0));
    let clock = Clock::of(stand.studio.world());
    let (surfaces, camera) = (stand.surfaces.clone(), stand.studio.camera());
    let mut variants = WAYS.map(|(name, way)| {
        let surfaces = &surfaces;
        Variant::new(name, move |headless: &mut Headless| {
            let world = headless.world();
            for surface in surfaces {
                let mut surface = world.entity_mut(*surface);
                let Some((lighting, [casts, _])) = way else {
                    surface.insert(Visibility::Hidden);
                    continue;
                };
                let settings = TexelSettings {
                    lighting,
                    ..default()
                };
                surface.insert((Visibility::Inherited, settings));
                if casts {
                    surface.remove::<NotShadowCaster>();
                } else {
                    surface.insert(NotShadowCaster);
                }
            }
            let mut camera = world.entity_mut(camera);
            if way.is_some_and(|(_, [_, prepass])| prepass) {
                camera.insert(DepthPrepass);
            } else {
                camera.remove::<DepthPrepass>();
            }
        })
    });
    let race = Race {
        rounds: if lab.quick { 3 } else { 21 },
        warm_up: 1,
        // Materials change, and follow a frame later.
        settle: 2,
    };
    let timings = race.run(&mut stand.studio.headless, &mut variants);
    let series = timings[1..].iter().zip(1u8..).map(|(timing, number)| {
        let above = timing.less(&timings[0]).ms(clock);
        println!("{}: {above:.1} ms", timing.name);
        let point = Point::from((f64::from(number), above));
        let label = format!("{above:.0} ms");
        Series::scatter(timing.name.as_str(), [point.labelled(label)])
    });
    let series = series.collect();
    Ok(Chart {
        title: format!(
            "Where the time of the plane goes, {} x {}",
            lab.size.x, lab.size.y
        ),
        subtitle: stand.adapter(),
        x: Axis::linear("way to draw it, in the order of the legend"),
        y: Axis::linear(format!("{} above the empty scene's (ms)", clock.label())),
        series,
    })
}
