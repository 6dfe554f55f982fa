//! Texels in fog: as much of it lies before them as before an ordinary mesh at the same place.

use bevy::prelude::*;
use bevy_verdure::lab::texel_scenes::all_slices;
use bevy_verdure::lab::{Lens, Pixels, Shot, Studio};
use bevy_verdure::prelude::*;
use bevy_verdure::texel::build::{HeightField, VolumeSettings, from_height_field};
use bevy_verdure::texel::color::srgb_to_linear;
use bevy_verdure::texel::silent;

use super::{SIZE, Square, cover};

/// Metres along each side of the field, of which pictures show the middle alone. A texel is one metre wide.
const FIELD: f32 = 16.0;

/// Height of its texels in metres, of which the lower half is solid.
const HEIGHT: f32 = 0.25;

/// Voxels along each side of its volume.
const SIDE: u32 = 32;

/// Where fog begins, and where there is nothing else: in metres from the eye.
const FOG: [f32; 2] = [5.0, 12.0];

/// From 6 m above, down at the field by 34 to 64 degrees: 6.5 to 10.5 m away.
const LOOK: Shot = Shot {
    eye: Vec3::new(8.0, 6.0, -3.0),
    at: Vec3::new(8.0, 0.0, -8.0),
    lens: Lens::Perspective(0.5),
    size: SIZE,
};

/// Flat ground of pure red, half as high as it may be.
fn slab() -> TexelVolume {
    let heights = vec![0.5; (SIDE * SIDE) as usize];
    let field = HeightField::new(UVec2::splat(SIDE), heights, [255, 0, 0]);
    let settings = VolumeSettings::new(UVec3::splat(SIDE));
    let built = from_height_field(&field, &settings, &silent);
    built.expect("the field is in range").volume.into()
}

/// The field of texels, and a plane of the same red where their upper side is.
fn spawn(studio: &mut Studio) -> [Entity; 2] {
    let unit = Square::default();
    let square = Square {
        positions: unit.positions.map(|at| at * FIELD),
        heights: [Vec3::Y * HEIGHT; 4],
        uvs: unit.uvs.map(|uv| uv * FIELD),
    };
    let settings = all_slices(PlantLighting::Unlit);
    let texels = cover(studio, &square, Transform::IDENTITY, settings);
    let world = studio.world();
    let volume = world.resource_mut::<Assets<TexelVolume>>().add(slab());
    let thickness = HEIGHT;
    world
        .entity_mut(texels)
        .insert(TexelSurface { volume, thickness });
    let mesh = Plane3d::default().mesh().size(FIELD, FIELD);
    let mesh = world.resource_mut::<Assets<Mesh>>().add(mesh);
    let red = StandardMaterial {
        base_color: Color::srgb(1.0, 0.0, 0.0),
        unlit: true,
        ..default()
    };
    let red = world.resource_mut::<Assets<StandardMaterial>>().add(red);
    let place = Transform::from_xyz(0.5 * FIELD, 0.5 * HEIGHT, -0.5 * FIELD);
    let plane = world.spawn((Mesh3d(mesh), MeshMaterial3d(red), place)).id();
    [texels, plane]
}

/// Pictures of the texels in no light, in simple and in full light, and of the plane.
fn pictures(studio: &mut Studio, [texels, plane]: [Entity; 2]) -> [Pixels; 4] {
    let mut show = |shown: [Visibility; 2], lighting| {
        let world = studio.world();
        world
            .entity_mut(texels)
            .insert((shown[0], all_slices(lighting)));
        world.entity_mut(plane).insert(shown[1]);
        studio.headless.step();
        studio.photograph(&LOOK, Color::BLACK)
    };
    let [first, second] = [
        [Visibility::Inherited, Visibility::Hidden],
        [Visibility::Hidden, Visibility::Inherited],
    ];
    [
        show(first, PlantLighting::Unlit),
        show(first, PlantLighting::Simple),
        show(first, PlantLighting::Full),
        show(second, PlantLighting::Unlit),
    ]
}

/// Green fog.
fn fog(studio: &mut Studio, [start, end]: [f32; 2]) {
    let camera = studio.camera();
    studio.world().entity_mut(camera).insert(DistanceFog {
        color: Color::srgb(0.0, 1.0, 0.0),
        falloff: FogFalloff::Linear { start, end },
        ..default()
    });
}

/// The share of fog in a colour, if it is another one without.
fn share(clear: [u8; 3], foggy: [u8; 3]) -> f32 {
    let green = |color: [u8; 3]| srgb_to_linear(f32::from(color[1]) / 255.0);
    (green(foggy) - green(clear)) / (1.0 - green(clear))
}

#[test]
fn texels_have_as_much_fog_before_them_as_an_ordinary_mesh() {
    let mut studio = Studio::default();
    let sun = DirectionalLight {
        illuminance: 2_000.0,
        ..default()
    };
    let down = Transform::default().looking_to(Vec3::new(0.3, -1.0, 0.2), Vec3::X);
    studio.world().spawn((sun, down));
    let both = spawn(&mut studio);
    let clear = pictures(&mut studio, both);
    fog(&mut studio, FOG);
    let foggy = pictures(&mut studio, both);
    // Slices are half a 32nd of the height below the plane, 7 mm along the flattest ray. Fog is that of the place where
    // light is received, above them: by HEIGHT/32·tan(a) with tan(a) ≤ 2.6 at the corners, and an eighth of e, 8 of 32
    // voxels, which is 52 mm together and less along rays. Half a byte of green is 0.004 where fog is four fifths, in both
    // pictures; GPUs may round by a fifth more, and clear ones are rounded too.
    let bound = 0.05 / (FOG[1] - FOG[0]) + 0.011;
    let (mut least, mut most, mut worst) = (1.0f32, 0.0f32, 0.0f32);
    for (x, y) in (0..SIZE.y).flat_map(|y| (0..SIZE.x).map(move |x| (x, y))) {
        let [unlit, simple, full, plane] =
            [0, 1, 2, 3].map(|i| share(clear[i].rgb(x, y), foggy[i].rgb(x, y)));
        for texels in [unlit, simple, full] {
            worst = worst.max((texels - plane).abs());
        }
        (least, most) = (least.min(plane), most.max(plane));
    }
    println!("{least:.3} to {most:.3} of fog, at worst {worst:.4} of {bound:.4} off");
    assert!(least < 0.3 && most > 0.7, "{least} {most}");
    assert!(worst < bound, "{worst}");

    fog(&mut studio, [0.0, 1.0]);
    for picture in pictures(&mut studio, both) {
        let bytes = picture.rgb_bytes();
        assert!(bytes.chunks_exact(3).all(|color| color == [0, 255, 0]));
    }
}
