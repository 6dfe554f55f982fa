//! Texels against the triangles that they stand for, instanced by Bevy: triangles, memory and time (§6).

use bevy::core_pipeline::prepass::DepthPrepass;
use bevy::prelude::*;
use bevy_verdure::lab::charts::{Axis, Chart, Point, Series};
use bevy_verdure::lab::texel_scenes::{FullMeshes, TexelScene, TexelStand};
use bevy_verdure::lab::{Clock, Headless, Race, Timing, Variant};
use bevy_verdure::prelude::*;

use super::lab::Lab;

/// The scenes whose volumes are made of triangles.
const SCENES: [TexelScene; 5] = [
    TexelScene::Pears,
    TexelScene::Bushes,
    TexelScene::Noise,
    TexelScene::Sphere,
    TexelScene::Plane,
];

/// A scene both ways, put up.
fn open(lab: &Lab, scene: TexelScene) -> Result<(TexelStand, FullMeshes), String> {
    let mut stand = lab.open(scene)?;
    let full = stand.put_up_full_meshes();
    let full = full.ok_or_else(|| format!("{}: it is not made of triangles", scene.name()))?;
    stand.set(TexelSettings::default());
    Ok((stand, full))
}

/// Shows the texels, or the triangles, or neither, with a depth prepass or without.
fn show(headless: &mut Headless, camera: Entity, groups: [&[Entity]; 2], way: Way) {
    let (shown, prepass) = way;
    let mut camera = headless.world().entity_mut(camera);
    if prepass {
        camera.insert(DepthPrepass);
    } else {
        camera.remove::<DepthPrepass>();
    }
    for (i, group) in groups.iter().enumerate() {
        let visibility = if shown == Some(i) {
            Visibility::Inherited
        } else {
            Visibility::Hidden
        };
        for entity in *group {
            headless.world().entity_mut(*entity).insert(visibility);
        }
    }
}

/// Which group is shown, and whether a prepass draws its depth first.
type Way = (Option<usize>, bool);

/// Times of the empty scene, of texels and of triangles, each without and with a depth prepass, in turns.
fn race(lab: &Lab, stand: &mut TexelStand, full: &FullMeshes) -> Vec<Timing> {
    let surfaces = stand.surfaces.clone();
    let groups = [surfaces.as_slice(), full.entities.as_slice()];
    let camera = stand.studio.camera();
    let ways = [
        ("empty", (None, false)),
        ("texels", (Some(0), false)),
        ("triangles", (Some(1), false)),
        ("texels, prepass", (Some(0), true)),
        ("triangles, prepass", (Some(1), true)),
    ];
    let mut variants = ways.map(|(name, way)| {
        Variant::new(name, move |h: &mut Headless| show(h, camera, groups, way))
    });
    let race = Race {
        rounds: if lab.quick { 3 } else { 21 },
        warm_up: 1,
        // A prepass starts a frame later.
        settle: 2,
    };
    race.run(&mut stand.studio.headless, &mut variants)
}

/// Time against triangles drawn.
pub fn time(lab: &Lab) -> Result<Chart, String> {
    let mut series =
        ["texels", "full meshes"].map(|name| Series::scatter(name, Vec::<Point>::new()));
    let (mut adapter, mut clock) = (String::new(), Clock::Frames);
    for scene in SCENES.into_iter().filter(|scene| lab.shows(*scene)) {
        let (mut stand, full) = open(lab, scene)?;
        let shot = lab.shot(scene, 1.0);
        stand.photograph(&shot);
        (adapter, clock) = (stand.adapter(), Clock::of(stand.studio.world()));
        let drawn = stand.count(&shot, &TexelSettings::default()).triangles;
        let timings = race(lab, &mut stand, &full);
        let above = |i: usize| timings[i].less(&timings[0]).ms(clock);
        // Each as a game's author would have it who measured both.
        let [own, other] = [1, 2].map(|i| above(i).min(above(i + 2)));
        println!(
            "{}: {drawn} triangles of slices, {:.1} ms, {:.1} ms with a prepass; {} triangles, {:.1} ms, {:.1} ms; \
             {:.1} times faster; empty {:.1} ms",
            scene.name(),
            above(1),
            above(3),
            full.triangles,
            above(2),
            above(4),
            other / own,
            timings[0].ms(clock),
        );
        for ((triangles, ms), series) in [(drawn, own), (full.triangles, other)]
            .into_iter()
            .zip(&mut series)
        {
            let point = Point::from((triangles as f64, ms));
            series.points.push(point.labelled(scene.name()));
        }
    }
    Ok(Chart {
        title: format!(
            "Texels and the triangles that they stand for, {} x {}, shadows on, with or without a depth prepass",
            lab.size.x, lab.size.y
        ),
        subtitle: adapter,
        x: Axis::log("triangles in the main view"),
        y: Axis::log(format!("{} above the empty scene's (ms)", clock.label())),
        series: series.into(),
    })
}

/// Memory against triangles.
pub fn memory(lab: &Lab) -> Result<Chart, String> {
    const MIB: f64 = 1024.0 * 1024.0;
    let mut series =
        ["texels", "full meshes"].map(|name| Series::scatter(name, Vec::<Point>::new()));
    let mut adapter = String::new();
    for scene in SCENES.into_iter().filter(|scene| lab.shows(*scene)) {
        let (mut stand, full) = open(lab, scene)?;
        adapter = stand.adapter();
        let settings = TexelSettings::default();
        let drawn = stand.count(&lab.shot(scene, 1.0), &settings).triangles;
        let own = stand.bytes(&settings) as f64 / MIB;
        let other = full.bytes as f64 / MIB;
        println!(
            "{}: texels {own:.2} MiB, full mesh {other:.2} MiB",
            scene.name()
        );
        for ((triangles, mib), series) in [(drawn, own), (full.triangles, other)]
            .into_iter()
            .zip(&mut series)
        {
            let point = Point::from((triangles as f64, mib));
            series.points.push(point.labelled(scene.name()));
        }
    }
    Ok(Chart {
        title: "Memory of texels, and of the triangles that they stand for".into(),
        subtitle: adapter,
        x: Axis::log("triangles in the main view"),
        y: Axis::log("MiB on the device, uncompressed"),
        series: series.into(),
    })
}
