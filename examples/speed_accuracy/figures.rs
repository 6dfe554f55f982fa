//! The paper's Figures 4, 5 and 6 as ours, with the error under each.

use std::path::Path;

use bevy::prelude::*;
use bevy_verdure::lab::rivals::{Exhibit, Judge, Rival, fitting};
use bevy_verdure::lab::{Lens, Pixels, Shot, Studio, mean_flip};
use bevy_verdure::plants::{Planting, Saguaro};
use bevy_verdure::prelude::*;

use super::lab::Lab;

/// Size of one picture.
const SIZE: UVec2 = UVec2::new(320, 240);

/// Draws all figures, and a page that shows them.
pub fn draw(dir: &Path) -> Result<(), String> {
    let mut lab = Lab::open();
    let mut page = format!(
        "# Figures 4, 5 and 6 of the frusta paper, anew\n\n\
         Drawn by `cargo run --example speed_accuracy -- --figures` on {}. Errors are mean FLIP against a picture of the \
         finest settings, four times as wide and high and averaged down.\n",
        lab.adapter
    );
    let [geometric, continuous] = normals(&mut Studio::default());
    page += "\n## Figure 4: normals\n\n";
    page += &row(
        dir,
        &[
            (
                "figure4_geometric",
                &geometric,
                "the surface's own, `ShadingNormals::Geometric`".into(),
            ),
            (
                "figure4_continuous",
                &continuous,
                "Equation 8, `ShadingNormals::Continuous`".into(),
            ),
        ],
    )?;
    page += &reliefs(&mut lab, dir)?;
    let file = dir.join("README.md");
    std::fs::write(&file, page).map_err(|error| format!("{}: {error}", file.display()))?;
    println!("{}", file.display());
    Ok(())
}

/// Writes pictures, and a table that shows them with a caption under each.
fn row(dir: &Path, pictures: &[(&str, &Pixels, String)]) -> Result<String, String> {
    let mut cells = [String::from("|"), String::from("|"), String::from("|")];
    for (name, picture, caption) in pictures {
        picture.save_png(&dir.join(format!("{name}.png")))?;
        cells[0] += &format!(" ![{caption}]({name}.png) |");
        cells[1] += ":-:|";
        cells[2] += &format!(" {caption} |");
    }
    Ok(cells.join("\n") + "\n")
}

/// Figure 4: a bent, glossy limb with either normals.
fn normals(studio: &mut Studio) -> [Pixels; 2] {
    let mut limb = Skeleton::builder();
    let mut last = limb.root(Vec3::new(-0.75, -0.35, 0.0), 0.24);
    for i in 1..=7u8 {
        let t = f32::from(i) / 7.0;
        let place = Vec3::new(-0.75 + 1.5 * t, -0.35 + 0.75 * (t * 3.1).sin(), 0.3 * t);
        let radius = if i % 2 == 0 { 0.22 } else { 0.15 };
        last = limb.joint(last, place, radius);
    }
    let limb = limb.build().expect("the limb is finite");
    let plant = studio.plant(limb, Frusta::default(), Transform::IDENTITY);
    let world = studio.world();
    world.insert_resource(GlobalAmbientLight {
        brightness: 500.0,
        ..default()
    });
    for (towards, illuminance) in [
        (Vec3::new(-0.3, -0.9, -0.5), 6_000.0),
        (Vec3::new(0.8, -0.2, -0.5), 2_500.0),
    ] {
        world.spawn((
            DirectionalLight {
                illuminance,
                ..default()
            },
            Transform::default().looking_to(towards, Vec3::Y),
        ));
    }
    let camera = studio.camera();
    studio.world().entity_mut(camera).insert(Msaa::default());
    let shot = Shot {
        eye: Vec3::new(0.0, 0.25, 2.2),
        at: Vec3::new(0.0, 0.05, 0.0),
        lens: Lens::Perspective(0.75),
        size: SIZE,
    };
    [ShadingNormals::Geometric, ShadingNormals::Continuous].map(|normals| {
        let mut material = frusta_material(StandardMaterial {
            base_color: Color::srgb(0.25, 0.45, 0.30),
            perceptual_roughness: 0.28,
            ..default()
        });
        material.extension.normals = normals;
        let world = studio.world();
        let material = world.resource_mut::<Assets<FrustaMaterial>>().add(material);
        world.entity_mut(plant).insert(MeshMaterial3d(material));
        studio.headless.step();
        studio.photograph(&shot, Color::srgb(0.9, 0.92, 0.95))
    })
}

/// Figures 5 and 6: three saguaros of 48 segments, which have 16·48·4^m triangles, and their caps.
fn reliefs(lab: &mut Lab, dir: &Path) -> Result<String, String> {
    let mut planting = Planting::default();
    for (i, (x, z)) in [(0.0, 0.0), (-1.5, -1.4), (1.7, -0.9)]
        .into_iter()
        .enumerate()
    {
        let saguaro = Saguaro {
            arms: 1,
            height: 3.6 - 0.3 * i as f32,
            ..default()
        };
        let plant = planting.add(saguaro.grow(i as u64));
        planting.place(plant, Vec3::new(x, 0.0, z), 0.6 + 1.9 * i as f32, 1.0);
    }
    let whole = fitting(&planting, Vec3::new(0.2, 0.1, 1.0), SIZE);
    // From the side of the first one, a metre away.
    let close = Shot {
        eye: Vec3::new(0.35, 2.35, 1.35),
        at: Vec3::new(0.0, 2.3, 0.0),
        ..whole
    };
    let mut exhibit = Exhibit::open(&mut lab.studio.headless, planting, None);
    let (plain, relief, finest) = (
        Rival::frusta(false),
        Rival::frusta(true),
        Rival::reference(true),
    );
    lab.put_up(&mut exhibit, &[plain, relief, finest])?;

    let judge = Judge::new(&mut lab.studio, &exhibit, finest, whole);
    let take = |lab: &mut Lab, judge: &Judge, exhibit: &Exhibit, rival| {
        let picture = judge.picture(&mut lab.studio, exhibit, rival);
        let flip = mean_flip((SIZE.x, SIZE.y), judge.reference(), &picture.rgb_bytes());
        (picture, flip)
    };
    let (without, with) = (
        take(lab, &judge, &exhibit, plain),
        take(lab, &judge, &exhibit, relief),
    );
    let mut page = String::from("\n## Figure 5: texture and relief\n\n");
    page += &row(
        dir,
        &[
            (
                "figure5_texture",
                &without.0,
                format!("texture: FLIP {:.4}", without.1),
            ),
            (
                "figure5_relief",
                &with.0,
                format!("relief: FLIP {:.4}", with.1),
            ),
        ],
    )?;

    let judge = Judge::new(&mut lab.studio, &exhibit, finest, close);
    let mut drawn = Vec::new();
    for (name, subdivisions) in [("figure6_16k", 2), ("figure6_64k", 3), ("figure6_256k", 4)] {
        let polygons = Rival::Polygons {
            subdivisions,
            relief: true,
        };
        lab.put_up(&mut exhibit, &[polygons])?;
        let (picture, flip) = take(lab, &judge, &exhibit, polygons);
        let triangles = exhibit.weight(polygons).unwrap_or_default().triangles;
        let caption = format!("{} thousand triangles: FLIP {flip:.4}", triangles / 1000);
        drawn.push((name, picture, caption));
        exhibit.take_down(&mut lab.studio.headless, polygons);
    }
    let (picture, flip) = take(lab, &judge, &exhibit, relief);
    drawn.push((
        "figure6_ray_cast",
        picture,
        format!("ray cast: FLIP {flip:.4}"),
    ));
    page += "\n## Figure 6: a close-up in ever more polygons, and ray cast\n";
    for two in drawn.chunks(2) {
        let two: Vec<_> = (two.iter())
            .map(|(name, picture, caption)| (*name, picture, caption.clone()))
            .collect();
        page += "\n";
        page += &row(dir, &two)?;
    }
    Ok(page)
}
