//! Where slicing fails: how much of what is behind shows through two blended slicings, against one alone (§2.3).

use bevy::camera::Hdr;
use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::prelude::*;
use bevy_verdure::lab::Studio;
use bevy_verdure::prelude::*;

use super::{CROWN, SIZE, UNLIT, baked, eye, mean, plant, plant_mesh, shot, sun};

/// How much lighter the middle of a crown is on screen before something `bright` than before black, from so many degrees off
/// an orientation: before white, the share of light that comes through.
fn through(studio: &mut Studio, angle: f32, bright: Color) -> f64 {
    let (low, high) = (3 * SIZE / 8, 5 * SIZE / 8);
    let all = [0.0, 120.0, 240.0].map(|azimuth| {
        let look = shot(eye(azimuth + angle, 0.0, 16.0));
        let [black, bright] = [Color::BLACK, bright].map(|background| {
            let picture = studio.photograph(&look, background);
            let pixels = (low.y..high.y).flat_map(|y| (low.x..high.x).map(move |x| (x, y)));
            let light = pixels.map(|(x, y)| {
                let [_, green, _] = picture.rgb(x, y);
                f64::from(Color::srgb_u8(0, green, 0).to_linear().green)
            });
            light.sum::<f64>()
        });
        bright - black
    });
    let area = (high - low).element_product();
    all.iter().sum::<f64>() / (3 * area) as f64
}

#[test]
fn as_much_shows_through_two_slicings_as_through_one_but_without_the_correction() {
    let paper = CrownSettings {
        order: SliceOrder::Paper,
        ..UNLIT
    };
    let ways = [
        ("default", CROWN.clone(), UNLIT),
        ("m_s = 0.5", CROWN.clone(), paper),
        ("m_s = 0", baked(0.0, 0.0), paper),
    ];
    let [default, corrected, plain] = ways.map(|(name, slicing, settings)| {
        let mut studio = Studio::default();
        let world = studio.world();
        let slicing = world.resource_mut::<Assets<Slicing>>().add(slicing);
        world.spawn((SlicedCrown(slicing), settings));
        studio.headless.step();
        let [one, two] = [0.0, 30.0].map(|angle| through(&mut studio, angle, Color::WHITE));
        println!("{name}: {one:.4} through one, {two:.4} through two");
        assert!(one > 0.02, "{name}: nothing shows through");
        two / one - 1.0
    });
    // f_c makes up for the average crown alone; m_s would have to be more for one as dense as this.
    assert!(2.0 * corrected.abs() < plain, "{corrected} {plain}");
    assert!(default.abs() < corrected.abs(), "{default} {corrected}");
}

#[test]
fn as_much_shows_through_as_through_the_mesh_before_tone_mapping_and_after() {
    let mut studio = Studio::default();
    sun(&mut studio);
    let camera = studio.camera();
    studio.world().entity_mut(camera).insert(Msaa::Sample4);
    // Over the mesh's, in line with an orientation and half-way to the next.
    let ratio = |studio: &mut Studio, bright: Color| {
        let both = |planted: Vec<Entity>, studio: &mut Studio| {
            studio.headless.step();
            let all = [0.0, 30.0].map(|angle| through(studio, angle, bright));
            for entity in planted {
                studio.world().despawn(entity);
            }
            all.iter().sum::<f64>()
        };
        let mesh = plant_mesh(studio, Transform::IDENTITY, false);
        let of_mesh = both(mesh, studio);
        let crown = plant(studio, default(), Transform::IDENTITY);
        both(vec![crown], studio) / of_mesh
    };
    let at_once = ratio(&mut studio, Color::WHITE);
    studio
        .world()
        .entity_mut(camera)
        .insert((Hdr, Tonemapping::TonyMcMapface));
    // A sky of three times white.
    let later = ratio(&mut studio, Color::linear_rgb(3.0, 3.0, 3.0));
    println!("{at_once:.3} of what the mesh lets through, {later:.3} tone mapped after blending");
    assert!((later / at_once - 1.0).abs() < 0.1, "{at_once} {later}");
}

#[test]
fn crowns_seen_from_above_and_below_are_lit_as_their_meshes_are() {
    let mut studio = Studio::default();
    sun(&mut studio);
    let elevations = [-30.0, 0.0, 30.0, 60.0, 90.0];
    let mut light = |plant: &dyn Fn(&mut Studio) -> Vec<Entity>| {
        let planted = plant(&mut studio);
        studio.headless.step();
        let light = elevations.map(|elevation| {
            let sides = [20.0, 140.0, 260.0].map(|azimuth| {
                let look = shot(eye(azimuth, elevation, 16.0));
                mean(&studio.photograph(&look, Color::BLACK), 1)
            });
            sides.iter().sum::<f64>()
        });
        for entity in planted {
            studio.world().despawn(entity);
        }
        light
    };
    let mesh = light(&|studio| plant_mesh(studio, Transform::IDENTITY, false));
    let crown = light(&|studio| vec![plant(studio, default(), Transform::IDENTITY)]);
    let ratios: [f64; 5] = core::array::from_fn(|i| crown[i] / mesh[i]);
    println!("{ratios:.3?}");
    let [least, most] = [f64::min, f64::max].map(|pick| ratios.into_iter().reduce(pick));
    // Nothing turned and no shadows received nearer the eye, 2.6: twice as bright as the mesh from below, darker from above.
    assert!(most < least.map(|least| 1.5 * least), "{ratios:?}");
}
