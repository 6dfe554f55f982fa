use bevy::light::NotShadowReceiver;
use bevy::prelude::*;
use bevy_verdure::lab::texel_scenes::{TexelScene, TexelStand};
use bevy_verdure::lab::{Lens, Shot, mean_flip};
use bevy_verdure::prelude::*;
fn main() {
    let scene = TexelScene::Sphere;
    let mut stand = TexelStand::open(scene).unwrap();
    let (eye, at) = scene.view();
    let size = UVec2::new(384, 288);
    let shot = Shot {
        eye,
        at,
        lens: Lens::Perspective(core::f32::consts::FRAC_PI_4),
        size,
    };
    let with = |d: f32, p: f32, lit: bool| TexelSettings {
        quality: TexelQuality {
            depth: d,
            pixels: p,
            ..default()
        },
        lit,
        ..default()
    };
    for (name, shadow, lit) in [
        ("lit", true, true),
        ("unreceiving", false, true),
        ("unlit", false, false),
    ] {
        if !shadow {
            for s in stand.surfaces.clone() {
                stand.studio.world().entity_mut(s).insert(NotShadowReceiver);
            }
        }
        let mut flips = vec![];
        let start = std::time::Instant::now();
        stand.set(with(1e-3, 0.0, lit));
        let r = stand.photograph(&shot);
        r.save_png(std::path::Path::new(&format!("/tmp/tx/{name}_all.png")))
            .unwrap();
        for (d, p) in [(0.5, 0.5), (0.5, 1.0)] {
            stand.set(with(d, p, lit));
            let q = stand.photograph(&shot);
            q.save_png(std::path::Path::new(&format!("/tmp/tx/{name}_{p}.png")))
                .unwrap();
            flips.push(mean_flip((size.x, size.y), &r.rgb_bytes(), &q.rgb_bytes()));
        }
        println!("{name}: {flips:?} {:?}", start.elapsed());
    }
}
