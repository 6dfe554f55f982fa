//! What is drawn, against rays marched through the voxels in double precision.
//!
//! Slices stand h apart, and h·tan(a) ≤ d where there are enough of them. A ray that enters something solid meets a
//! slice of it no more than one spacing, h/|c|, further on; if it has left it before, what it misses lies within
//! h·tan(a) of an outline. So each pixel shows a place, and colours are places here, that is within one spacing of what
//! the reference sees within h·tan(a) of it.

use bevy::math::DVec3;
use bevy::prelude::*;
use bevy_verdure::lab::texel::{ReferenceSteps, ReferenceTexels};
use bevy_verdure::lab::{Pixels, Shot, Studio};
use bevy_verdure::prelude::*;
use bevy_verdure::texel::facet::{Facet, TexelFrame, bend};
use bevy_verdure::texel::{Choice, TexelQuality, TexelView, VolumeMeasure, choose};

use super::{
    BACKGROUND, LOLLY, SIDE, SIZE, Square, cover, is_background, rays, reference, shot, unlit,
};

/// How far slices may lead from the truth, over all facets: along a ray, and on screen.
#[derive(Debug, Default)]
struct Bounds {
    /// The spacing along rays, in lengths of the space.
    behind: f64,
    /// Pixels about an outline.
    aside: f64,
}

fn bounds(facets: &[Facet], shot: &Shot, settings: &TexelSettings) -> Bounds {
    let bevy_verdure::lab::Lens::Perspective(fov) = shot.lens else {
        panic!("perspective shots only");
    };
    let measure = VolumeMeasure::of(&LOLLY, settings.most_slices);
    let pixels = shot.size.y as f32 / 2.0 / (fov / 2.0).tan();
    let view = TexelView {
        eye: shot.eye,
        direction: None,
        pixels,
        half_spaces: [Vec4::ZERO; 6],
    };
    let mut bounds = Bounds::default();
    for facet in facets {
        let Choice::Slices { axis, exponent, .. } =
            choose(facet, &measure, &view, &settings.quality)
        else {
            panic!("in view");
        };
        // Filtering rounds the corners of voxels, by half their diagonal.
        let voxel = facet.heights[0].length() / SIDE as f32 * 0.5 * 3f32.sqrt();
        let nearest = facet.bounds().0.distance(shot.eye) - facet.bounds().1;
        let rounded = f64::from(voxel * pixels / nearest);
        let h = |length: f32| length / (1u32 << exponent) as f32;
        // Angles differ over a facet; the corners have the greatest.
        for (b, w) in [Vec3::X, Vec3::Y, Vec3::Z]
            .into_iter()
            .flat_map(|b| [(b, 0.0), (b, 1.0)])
        {
            let at = facet.point(b, w);
            let direction = (at - shot.eye).normalize();
            let (normal, length) = TexelFrame::new(facet, b, w).normal_and_length(axis);
            let c = normal.dot(direction).abs();
            let z = at.distance(shot.eye);
            bounds.behind = bounds.behind.max(f64::from(h(length) / c));
            let aside = h(length) * (1.0 - c * c).sqrt() / c * pixels / z;
            bounds.aside = bounds.aside.max(rounded + f64::from(aside));
        }
    }
    bounds
}

/// All pixels must show a place that the reference sees nearly there, or nothing where it sees nothing near.
fn compare(name: &str, picture: &Pixels, facets: &[Facet], shot: &Shot, settings: &TexelSettings) {
    let references: Vec<_> = facets.iter().map(reference).collect();
    let texels = ReferenceTexels::new(&LOLLY, &references, ReferenceSteps { per_voxel: 3.0 });
    let places: Vec<Option<DVec3>> = rays(shot)
        .map(|(origin, direction)| {
            let hit = texels.cast(origin, direction, 0.0)?;
            Some(hit.uvw - hit.copy.as_dvec2().extend(0.0))
        })
        .collect();
    let bounds = bounds(facets, shot, settings);
    // A ray may leave a facet before it meets a slice, and has one spacing more to go on the next. Colours are those of
    // voxels, to half a diagonal, filtered over as much again, in bytes.
    let bound = 2.0 * bounds.behind + 3f64.sqrt() / f64::from(SIDE) + 1.0 / 255.0;
    let reach = bounds.aside.ceil() as i32 + 1;
    let size = SIZE.as_ivec2();
    let mut worst = 0.0f64;
    for (x, y) in (0..size.y).flat_map(|y| (0..size.x).map(move |x| (x, y))) {
        let columns = (x - reach).max(0)..(x + reach + 1).min(size.x);
        let rows = (y - reach).max(0)..(y + reach + 1).min(size.y);
        let around = rows.flat_map(|row| columns.clone().map(move |column| row * size.x + column));
        let mut near = around.map(|i| places[i as usize]);
        let color = picture.rgb(x as u32, y as u32);
        if is_background(color) {
            assert!(
                near.any(|place| place.is_none()),
                "{name}: a hole at {x}, {y}"
            );
            continue;
        }
        let seen = DVec3::from(color.map(f64::from)) / 255.0;
        let off = near.flatten().map(|place| place.distance(seen));
        let off = off.fold(f64::INFINITY, f64::min);
        worst = worst.max(off);
        assert!(
            off <= bound,
            "{name}: {x}, {y} shows {seen}, {off} from all that is near"
        );
    }
    let solid = places.iter().flatten().count();
    println!("{name}: {solid} solid pixels, worst {worst:.4} of {bound:.4} within {reach} pixels");
    // So near that there is something to see, and so fine that a wrong place shows.
    assert!(
        solid > 500 && reach <= 8 && bound < 0.35,
        "{name}: {solid} {reach} {bound}"
    );
}

/// So that little is seen that is not the surface: by default half of what is thick may be.
fn fine() -> TexelSettings {
    TexelSettings {
        quality: TexelQuality {
            depth: 0.05,
            ..default()
        },
        ..unlit()
    }
}

/// Eyes above, aslant, grazing, and beside.
const EYES: [Vec3; 4] = [
    Vec3::new(0.6, 3.2, -0.4),
    Vec3::new(1.9, 2.3, 1.2),
    Vec3::new(0.2, 0.75, 2.2),
    Vec3::new(3.1, 0.5, -0.7),
];

#[test]
fn a_texel_is_seen_as_marched_rays_see_it_from_above_aslant_and_grazing() {
    let mut studio = Studio::default();
    let square = Square::default();
    cover(&mut studio, &square, Transform::IDENTITY, fine());
    for eye in EYES {
        let picture = studio.photograph(&shot(eye), BACKGROUND);
        let facets = square.facets(&Transform::IDENTITY);
        compare(&format!("{eye}"), &picture, &facets, &shot(eye), &fine());
    }
}

#[test]
fn texels_that_overlap_interpenetrate() {
    let mut studio = Studio::default();
    let square = Square::default();
    let places = [
        Transform::IDENTITY,
        Transform::from_xyz(0.3, 0.1, -0.2).with_rotation(Quat::from_rotation_y(0.5)),
    ];
    let mut facets = Vec::new();
    for place in places {
        cover(&mut studio, &square, place, fine());
        facets.extend(square.facets(&place));
    }
    for eye in EYES {
        let picture = studio.photograph(&shot(eye), BACKGROUND);
        compare(&format!("{eye}"), &picture, &facets, &shot(eye), &fine());
    }
}

#[test]
fn bent_height_vectors_mirrored_textures_and_many_texels_on_a_facet_are_seen_as_marched() {
    let bent = Square {
        heights: [
            Vec3::new(0.2, 1.0, 0.0),
            Vec3::new(0.3, 1.1, 0.1),
            Vec3::new(0.2, 1.2, -0.1),
            Vec3::new(0.1, 1.0, 0.0),
        ],
        ..default()
    };
    let turned = Square {
        // Rotated, mirrored, and off the border of the texture.
        uvs: [
            Vec2::new(0.2, 1.1),
            Vec2::new(0.2, 0.0),
            Vec2::new(1.3, 0.0),
            Vec2::new(1.3, 1.1),
        ],
        ..default()
    };
    for (name, square) in [("bent", bent), ("turned", turned)] {
        let mut studio = Studio::default();
        cover(&mut studio, &square, Transform::IDENTITY, fine());
        for eye in &EYES[1..3] {
            let picture = studio.photograph(&shot(*eye), BACKGROUND);
            let facets = square.facets(&Transform::IDENTITY);
            compare(
                &format!("{name} {eye}"),
                &picture,
                &facets,
                &shot(*eye),
                &unlit(),
            );
        }
    }
}

#[test]
fn surfaces_and_height_vectors_that_move_are_followed() {
    let mut studio = Studio::default();
    let square = Square::default();
    let surface = cover(&mut studio, &square, Transform::IDENTITY, fine());
    let eye = EYES[1];
    studio.photograph(&shot(eye), BACKGROUND);
    let place = Transform::from_xyz(0.2, -0.1, 0.1).with_scale(Vec3::splat(0.9));
    studio.world().entity_mut(surface).insert(place);
    let picture = studio.photograph(&shot(eye), BACKGROUND);
    compare(
        "moved",
        &picture,
        &square.facets(&place),
        &shot(eye),
        &fine(),
    );
    let leaning = Square {
        heights: [Vec3::new(-0.3, 0.9, 0.2); 4],
        ..square
    };
    let world = studio.world();
    let mesh = world.get::<Mesh3d>(surface).unwrap().0.clone();
    let mut meshes = world.resource_mut::<Assets<Mesh>>();
    *meshes.get_mut(&mesh).unwrap() = leaning.mesh();
    // Edits are told of in the next frame.
    studio.headless.step();
    let picture = studio.photograph(&shot(eye), BACKGROUND);
    compare(
        "leaning",
        &picture,
        &leaning.facets(&place),
        &shot(eye),
        &fine(),
    );
}

#[test]
fn height_vectors_of_a_surface_and_live_meshes_are_followed() {
    let mut studio = Studio::default();
    let square = Square::default();
    let surface = cover(&mut studio, &square, Transform::IDENTITY, fine());
    let eye = EYES[1];
    studio.photograph(&shot(eye), BACKGROUND);
    let stroked = Square {
        heights: [Vec3::new(0.3, 0.8, 0.1); 4],
        ..square.clone()
    };
    studio
        .world()
        .entity_mut(surface)
        .insert(TexelHeights(stroked.heights.to_vec()));
    let picture = studio.photograph(&shot(eye), BACKGROUND);
    let facets = stroked.facets(&Transform::IDENTITY);
    compare("stroked", &picture, &facets, &shot(eye), &fine());

    studio
        .world()
        .entity_mut(surface)
        .remove::<TexelHeights>()
        .insert(LiveTexels);
    let raised = Square {
        positions: square.positions.map(|at| at + Vec3::new(0.0, 0.2, 0.0)),
        ..square
    };
    let world = studio.world();
    let mesh = world.get::<Mesh3d>(surface).unwrap().0.clone();
    *world.resource_mut::<Assets<Mesh>>().get_mut(&mesh).unwrap() = raised.mesh();
    let picture = studio.photograph(&shot(eye), BACKGROUND);
    let facets = raised.facets(&Transform::IDENTITY);
    compare("raised", &picture, &facets, &shot(eye), &fine());
}

#[test]
fn a_surface_that_shares_its_mesh_with_a_live_one_is_followed_too() {
    let mut studio = Studio::default();
    let square = Square::default();
    let surface = cover(&mut studio, &square, Transform::IDENTITY, fine());
    let world = studio.world();
    let (mesh, texels) = (
        world.get::<Mesh3d>(surface).unwrap().clone(),
        world.get::<TexelSurface>(surface).unwrap().clone(),
    );
    let aside = Transform::from_xyz(100.0, 0.0, 0.0);
    world.spawn((mesh.clone(), texels, fine(), aside, LiveTexels));
    let eye = EYES[1];
    studio.photograph(&shot(eye), BACKGROUND);
    let raised = Square {
        positions: square.positions.map(|at| at + Vec3::new(0.0, 0.2, 0.0)),
        ..square
    };
    let mut meshes = studio.world().resource_mut::<Assets<Mesh>>();
    *meshes.get_mut(&mesh.0).unwrap() = raised.mesh();
    // Edits are told of in the next frame.
    studio.headless.step();
    let picture = studio.photograph(&shot(eye), BACKGROUND);
    let facets = raised.facets(&Transform::IDENTITY);
    compare("shared", &picture, &facets, &shot(eye), &fine());
}

#[test]
fn wind_bends_height_vectors_as_the_formula_does() {
    let mut studio = Studio::default();
    let square = Square::default();
    let flexible = TexelSettings {
        flexibility: 0.05,
        ..fine()
    };
    let velocity = Vec3::new(6.0, 0.0, 3.0);
    studio.world().insert_resource(Wind::new(velocity));
    cover(&mut studio, &square, Transform::IDENTITY, flexible);
    let eye = EYES[1];
    let picture = studio.photograph(&shot(eye), BACKGROUND);
    let time = studio.world().resource::<Time>().elapsed_secs();
    let facets = square.facets(&Transform::IDENTITY).map(|facet| {
        let heights =
            [0, 1, 2].map(|i| bend(facet.positions[i], facet.heights[i], velocity, 0.05, time));
        Facet { heights, ..facet }
    });
    let lean = facets[0].heights[0].normalize().dot(Vec3::Y).acos();
    assert!(lean > 0.1, "{lean}");
    compare("wind", &picture, &facets, &shot(eye), &fine());
}
