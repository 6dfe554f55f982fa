//! What a plant does besides standing in the light: each feature against what it should be.

use bevy::asset::RenderAssetUsages;
use bevy::camera::primitives::Aabb;
use bevy::camera::visibility::{NoFrustumCulling, RenderLayers};
use bevy::core_pipeline::core_3d::AlphaMask3d;
use bevy::light::{CascadeShadowConfigBuilder, NotShadowCaster, NotShadowReceiver};
use bevy::prelude::*;
use bevy::render::RenderApp;
use bevy::render::render_phase::ViewBinnedRenderPhases;
use bevy::render::render_resource::{Extent3d, TextureDimension, TextureFormat};
use bevy_verdure::lab::{Lens, NEAR, Shot, Studio};
use bevy_verdure::prelude::*;

use crate::skeletons::{Dice, Growth, Roll, TREE, ball, double, reference};

const SIZE: UVec2 = UVec2::new(256, 192);

fn shot(eye: Vec3, at: Vec3) -> Shot {
    Shot {
        eye,
        at,
        lens: Lens::Perspective(0.8),
        size: SIZE,
    }
}

/// A white floor at height 0.
fn floor(world: &mut World) -> Entity {
    let mesh = world
        .resource_mut::<Assets<Mesh>>()
        .add(Plane3d::default().mesh().size(20.0, 20.0));
    let white = world
        .resource_mut::<Assets<StandardMaterial>>()
        .add(StandardMaterial {
            base_color: Color::WHITE,
            perceptual_roughness: 1.0,
            reflectance: 0.0,
            ..default()
        });
    world.spawn((Mesh3d(mesh), MeshMaterial3d(white))).id()
}

fn dark(studio: &mut Studio) {
    studio.world().insert_resource(GlobalAmbientLight::NONE);
}

/// Counts floor pixels whose shadow is not the reference's, and that are not within `blur` metres of its edge.
fn wrong_shadows(
    light: impl Bundle,
    towards: impl Fn(Vec3) -> (Vec3, f32),
    reaches: impl Fn(Vec3) -> bool,
    blur: f32,
) -> (usize, usize) {
    let mut studio = Studio::default();
    dark(&mut studio);
    floor(studio.world());
    studio.world().spawn(light);
    let skeleton = TREE.grow(&mut Dice::new(11));
    let scene = reference(&skeleton);
    let (_, radius) = ball(&skeleton);
    studio.plant(skeleton, Frusta::default(), Transform::IDENTITY);
    let shot = shot(Vec3::new(0.3, 1.9, 0.6) * radius, Vec3::Y * 0.2);
    let picture = studio.photograph(&shot, Color::BLACK);
    let shadowed = |point: Vec3| {
        let (direction, distance) = towards(point);
        let start = double(point) + double(direction) * 1e-3;
        scene
            .cast(start, double(direction), 0.0)
            .is_some_and(|hit| hit.t < f64::from(distance))
    };
    let (mut wrong, mut in_shadow) = (0, 0);
    for y in 0..SIZE.y {
        for x in 0..SIZE.x {
            let (origin, direction) = shot.ray(x as f32 + 0.5, y as f32 + 0.5);
            let t = -origin.y / direction.y;
            let hidden = scene.cast(origin, direction, f64::from(NEAR)).is_some();
            let point = (origin + direction * t).as_vec3();
            if t <= 0.0 || hidden || !reaches(point) {
                continue;
            }
            let expected = shadowed(point);
            let sure = (0..8).all(|i| {
                let (sin, cos) = (i as f32 * core::f32::consts::FRAC_PI_4).sin_cos();
                shadowed(point + Vec3::new(cos, 0.0, sin) * blur) == expected
            });
            if sure {
                in_shadow += usize::from(expected);
                let is_dark = picture.rgb(x, y)[1] < 20;
                wrong += usize::from(is_dark != expected);
            }
        }
    }
    (wrong, in_shadow)
}

#[test]
fn shadows_fall_where_the_reference_says() {
    let to_sun = Vec3::new(0.5, 0.8, 0.35).normalize();
    let sun = (
        DirectionalLight {
            illuminance: 20_000.0,
            shadow_maps_enabled: true,
            ..default()
        },
        CascadeShadowConfigBuilder {
            maximum_distance: 25.0,
            ..default()
        }
        .build(),
        Transform::default().looking_to(-to_sun, Vec3::Y),
    );
    let lamp = Vec3::new(2.5, 6.0, 2.0);
    let to_lamp = move |point: Vec3| ((lamp - point).normalize(), lamp.distance(point));
    let bulb = (
        PointLight {
            intensity: 9e6,
            range: 60.0,
            shadow_maps_enabled: true,
            ..default()
        },
        Transform::from_translation(lamp),
    );
    let beam = (
        SpotLight {
            intensity: 8e6,
            shadow_maps_enabled: true,
            ..default()
        },
        Transform::from_translation(lamp).looking_at(Vec3::Y, Vec3::Y),
    );
    // Well inside the beam, whose edge, at 45°, is soft.
    let axis = (Vec3::Y - lamp).normalize();
    let in_beam = move |point: Vec3| (point - lamp).normalize().dot(axis) > 0.85;
    // A few texels of the shadow maps: filtering, and the bias that keeps surfaces from shadowing themselves.
    for (name, (wrong, in_shadow)) in [
        (
            "sun",
            wrong_shadows(sun, move |_| (to_sun, 1e3), |_| true, 0.10),
        ),
        ("point", wrong_shadows(bulb, to_lamp, |_| true, 0.10)),
        ("spot", wrong_shadows(beam, to_lamp, in_beam, 0.10)),
    ] {
        println!("{name}: {wrong} wrong, {in_shadow} in shadow");
        assert!(in_shadow > 300, "{name}: {in_shadow} pixels in shadow");
        assert_eq!(wrong, 0, "{name}");
    }
}

#[test]
fn casting_and_receiving_can_be_switched_off() {
    // A trunk under a beam: with the sun behind the beam, the beam's shadow lies on the trunk.
    let brightness = |caster: bool, receiver: bool| {
        let mut studio = Studio::default();
        dark(&mut studio);
        studio.world().spawn((
            DirectionalLight {
                illuminance: 15_000.0,
                shadow_maps_enabled: true,
                ..default()
            },
            CascadeShadowConfigBuilder {
                maximum_distance: 12.0,
                ..default()
            }
            .build(),
            Transform::default().looking_to(Vec3::new(0.0, -1.0, -1.0), Vec3::Y),
        ));
        let trunk = |a: Vec3, b: Vec3, radius| {
            Skeleton::new(vec![Joint::root(a, radius), Joint::new(b, radius, 0)]).unwrap()
        };
        let upright = trunk(Vec3::ZERO, Vec3::Y * 2.0, 0.3);
        let beam = trunk(Vec3::new(-2.0, 2.0, 1.0), Vec3::new(2.0, 2.0, 1.0), 0.25);
        let upright = studio.plant(upright, Frusta::default(), Transform::IDENTITY);
        let beam = studio.plant(beam, Frusta::default(), Transform::IDENTITY);
        if !caster {
            studio.world().entity_mut(beam).insert(NotShadowCaster);
        }
        if !receiver {
            studio.world().entity_mut(upright).insert(NotShadowReceiver);
        }
        let shot = shot(Vec3::new(0.0, 1.0, 5.0), Vec3::Y);
        let picture = studio.photograph(&shot, Color::BLACK);
        // Where the ray from the beam's axis at 45° meets the trunk's front: y = 2 − (1 − 0.3).
        let (x, y) = (
            SIZE.x / 2,
            SIZE.y / 2 - ((1.3 - 1.0) / (4.7 * 0.4f32.tan()) * 96.0) as u32,
        );
        picture.rgb(x, y)[1]
    };
    assert!(brightness(true, true) < 10);
    assert!(brightness(false, true) > 60);
    assert!(brightness(true, false) > 60);
}

#[test]
fn any_invertible_transform_is_drawn_as_the_reference_says() {
    let skeleton = TREE.grow(&mut Dice::new(5));
    let scene = reference(&skeleton);
    let (centre, radius) = ball(&skeleton);
    let mut studio = Studio::default();
    for transform in [
        Transform::from_scale(Vec3::new(-1.0, 1.0, 1.0)),
        Transform::from_xyz(3.0, -1.0, 2.0)
            .with_rotation(Quat::from_euler(EulerRot::XYZ, 0.4, 1.1, -0.7))
            .with_scale(Vec3::new(0.6, -1.5, 0.9)),
        Transform::from_rotation(Quat::from_rotation_z(0.6)).with_scale(Vec3::splat(0.02)),
    ] {
        let plant = studio.plant(skeleton.clone(), Frusta::default(), transform);
        let handle = studio
            .world()
            .get::<MeshMaterial3d<FrustaMaterial>>(plant)
            .unwrap()
            .0
            .clone();
        let mut materials = studio.world().resource_mut::<Assets<FrustaMaterial>>();
        materials.get_mut(&handle).unwrap().extension.normals = ShadingNormals::Geometric;
        let size = radius * transform.scale.abs().max_element();
        let at = transform.transform_point(centre);
        let shot = shot(at + Vec3::new(0.8, 0.4, 1.9) * size, at);
        let figures = studio.measure(&shot);
        let world_from_local = transform.to_matrix().as_dmat4();
        let local_from_world = world_from_local.inverse();
        let (mut wrong, mut hits) = (0, 0);
        for y in 0..SIZE.y {
            for x in 0..SIZE.x {
                let (origin, direction) = shot.ray(x as f32 + 0.5, y as f32 + 0.5);
                let origin = local_from_world.transform_point3(origin);
                let direction = local_from_world.transform_vector3(direction);
                let expected = scene.cast(origin, direction, f64::from(NEAR));
                let seen = figures.get(x, y);
                wrong += usize::from(
                    expected.map(|hit| hit.segment as u32) != seen.map(|seen| seen.segment),
                );
                if let (Some(hit), Some(seen)) = (expected, seen)
                    && hit.segment as u32 == seen.segment
                {
                    hits += 1;
                    assert!(
                        (f64::from(seen.depth) - hit.t).abs() <= 1e-4 * hit.t,
                        "{x},{y}"
                    );
                    let normal = local_from_world
                        .transpose()
                        .transform_vector3(hit.surface_normal);
                    let cosine = normal.normalize().dot(double(seen.normal));
                    assert!(cosine > 0.999, "normal at {x},{y}: {cosine}");
                }
            }
        }
        println!("{transform:?}: {hits} hits, {wrong} wrong");
        assert!(hits > 1000);
        assert!(wrong <= 25, "{wrong} pixels, all along edges");
        studio.uproot(plant);
    }
}

#[test]
fn textures_leave_no_seam_where_u_starts_anew() {
    // Mip levels from the third on are red: a gradient across the seam, a whole texture wide, would show them.
    let size = 64u32;
    let mut data = Vec::new();
    for level in 0..=size.ilog2() {
        let colour = if level < 3 {
            [255, 255, 255, 255]
        } else {
            [255, 0, 0, 255]
        };
        data.extend(colour.repeat(((size >> level) * (size >> level)) as usize));
    }
    let extent = Extent3d {
        width: size,
        height: size,
        depth_or_array_layers: 1,
    };
    let mut image = Image::new_uninit(
        extent,
        TextureDimension::D2,
        TextureFormat::Rgba8Unorm,
        RenderAssetUsages::RENDER_WORLD,
    );
    image.texture_descriptor.mip_level_count = size.ilog2() + 1;
    image.data = Some(data);
    image.sampler = bevy::image::ImageSampler::Descriptor(bevy::image::ImageSamplerDescriptor {
        address_mode_u: bevy::image::ImageAddressMode::Repeat,
        address_mode_v: bevy::image::ImageAddressMode::Repeat,
        ..bevy::image::ImageSamplerDescriptor::linear()
    });
    let mut studio = Studio::default();
    let image = studio.world().resource_mut::<Assets<Image>>().add(image);
    let material = frusta_material(StandardMaterial {
        base_color_texture: Some(image),
        unlit: true,
        ..default()
    });
    let material = studio
        .world()
        .resource_mut::<Assets<FrustaMaterial>>()
        .add(material);
    let mut trunk = Skeleton::builder();
    let base = trunk.root(Vec3::ZERO, 0.5);
    let middle = trunk.joint(base, Vec3::new(0.0, 1.0, 0.0), 0.4);
    trunk.joint(middle, Vec3::new(0.3, 2.0, 0.1), 0.4);
    let skeleton = studio
        .world()
        .resource_mut::<Assets<Skeleton>>()
        .add(trunk.build().unwrap());
    studio
        .world()
        .spawn((Skeleton3d(skeleton), MeshMaterial3d(material)));
    // u = 0 is towards +z, and so is the eye.
    let shot = shot(Vec3::new(0.0, 1.0, 2.6), Vec3::Y);
    let picture = studio.photograph(&shot, Color::BLACK);
    let mut white = 0;
    for y in 40..150 {
        for x in SIZE.x / 2 - 16..SIZE.x / 2 + 16 {
            let [r, g, _] = picture.rgb(x, y);
            assert!(g > 250, "{x},{y} is {r},{g}: a smaller mip level shows");
            white += 1;
        }
    }
    assert!(white > 3000);
}

#[test]
fn cameras_see_the_layers_that_they_are_on() {
    let mut studio = Studio::default();
    let trunk = |x: f32| {
        let joints = vec![
            Joint::root(Vec3::X * x, 0.3),
            Joint::new(Vec3::new(x, 1.0, 0.0), 0.3, 0),
        ];
        Skeleton::new(joints).unwrap()
    };
    let left = studio.plant(trunk(-0.6), Frusta::default(), Transform::IDENTITY);
    let right = studio.plant(trunk(0.6), Frusta::default(), Transform::IDENTITY);
    studio
        .world()
        .entity_mut(left)
        .insert(RenderLayers::layer(1));
    studio
        .world()
        .entity_mut(right)
        .insert(RenderLayers::layer(2));
    // A second camera, on the other layer, that looks at the same time.
    let second = studio.headless.target(SIZE, TextureFormat::Rgba32Float);
    let shot = shot(Vec3::new(0.0, 0.5, 4.0), Vec3::Y * 0.5);
    studio.world().spawn((
        Camera3d::default(),
        Camera {
            order: 1,
            clear_color: ClearColorConfig::Custom(LinearRgba::new(-1.0, -1.0, -1.0, -1.0).into()),
            ..default()
        },
        second.clone(),
        Msaa::Off,
        bevy::core_pipeline::tonemapping::Tonemapping::None,
        shot.transform(),
        shot.projection(),
        RenderLayers::layer(2),
    ));
    let camera = studio.camera();
    studio
        .world()
        .entity_mut(camera)
        .insert(RenderLayers::layer(1));
    let first = studio.measure_output(&shot, FrustaOutput::Geometry);
    let second = studio.headless.capture(&second);
    let is_seen =
        |picture: &bevy_verdure::lab::Pixels, x: u32| picture.floats(x, SIZE.y / 2)[1] >= 0.0;
    let (left, right) = (SIZE.x / 2 - 34, SIZE.x / 2 + 34);
    assert_eq!(
        (is_seen(&first, left), is_seen(&first, right)),
        (true, false)
    );
    assert_eq!(
        (is_seen(&second, left), is_seen(&second, right)),
        (false, true)
    );
}

#[test]
fn bounds_follow_the_pose_and_culling_follows_the_bounds() {
    let mut studio = Studio::default();
    let skeleton = TREE.grow(&mut Dice::new(21));
    let plant = studio.plant(skeleton.clone(), Frusta::default(), Transform::IDENTITY);
    let mut dice = Dice::new(3);
    for _ in 0..6 {
        let rotations = (0..skeleton.len())
            .map(|_| Quat::from_axis_angle(dice.direction(), dice.between(-1.0, 1.0)))
            .collect();
        studio
            .world()
            .entity_mut(plant)
            .insert(SkeletonPose { rotations });
        let (centre, radius) = ball(&skeleton);
        let shot = shot(centre + Vec3::new(0.0, 0.3, 2.5) * radius, centre);
        let figures = studio.measure(&shot);
        let aabb = *studio.world().get::<Aabb>(plant).unwrap();
        let (low, high) = (Vec3::from(aabb.min()), Vec3::from(aabb.max()));
        let mut inside = 0;
        for y in 0..SIZE.y {
            for x in 0..SIZE.x {
                let Some(seen) = figures.get(x, y) else {
                    continue;
                };
                let (origin, direction) = shot.ray(x as f32 + 0.5, y as f32 + 0.5);
                let point = (origin + direction * f64::from(seen.depth)).as_vec3();
                assert!(point.cmpge(low - 1e-3).all() && point.cmple(high + 1e-3).all());
                inside += 1;
            }
        }
        assert!(inside > 500);
    }
    // Beside the view the plant is culled, unless that is switched off.
    let away = shot(Vec3::new(0.0, 0.0, 50.0), Vec3::new(0.0, 0.0, 100.0));
    studio.measure(&away);
    assert!(!studio.world().get::<ViewVisibility>(plant).unwrap().get());
    studio.world().entity_mut(plant).insert(NoFrustumCulling);
    studio.measure(&away);
    assert!(studio.world().get::<ViewVisibility>(plant).unwrap().get());
}

#[test]
fn plants_that_share_a_material_are_one_draw() {
    let mut studio = Studio::default();
    let mut dice = Dice::new(4);
    let material = frusta_material(Color::WHITE);
    let material = studio
        .world()
        .resource_mut::<Assets<FrustaMaterial>>()
        .add(material);
    for i in 0..40u8 {
        // 21 or 22 segments, as the dancing cacti have.
        let growth = Growth {
            joints: 22 + usize::from(i % 2),
            ..TREE
        };
        let skeleton = growth.grow(&mut dice);
        let skeleton = studio
            .world()
            .resource_mut::<Assets<Skeleton>>()
            .add(skeleton);
        let place = Vec3::new(f32::from(i % 8) - 4.0, 0.0, f32::from(i / 8));
        studio.world().spawn((
            Skeleton3d(skeleton),
            MeshMaterial3d(material.clone()),
            Transform::from_translation(place),
        ));
    }
    studio.photograph(&shot(Vec3::new(0.0, 8.0, 30.0), Vec3::ZERO), Color::BLACK);
    let render = studio.headless.app().sub_app(RenderApp).world();
    let phases = render.resource::<ViewBinnedRenderPhases<AlphaMask3d>>();
    let draws: Vec<usize> = phases
        .values()
        .map(|phase| {
            phase.multidrawable_meshes.len()
                + phase.batchable_meshes.len()
                + phase.unbatchable_meshes.len()
        })
        .filter(|draws| *draws > 0)
        .collect();
    assert_eq!(draws, [1]);
}

#[test]
fn what_moves_is_uploaded_and_what_stands_still_is_not() {
    let mut studio = Studio::default();
    let skeleton = Growth { joints: 24, ..TREE }.grow(&mut Dice::new(6));
    let segments = skeleton.segment_count();
    let still = studio.plant(skeleton.clone(), Frusta::default(), Transform::IDENTITY);
    let bent = studio.plant(skeleton.clone(), Frusta::default(), Transform::IDENTITY);
    let pose = |angle: f32| SkeletonPose {
        rotations: vec![Quat::from_rotation_x(angle); skeleton.len()],
    };
    studio.world().entity_mut(bent).insert(pose(0.0));
    for _ in 0..4 {
        studio.headless.step();
    }
    let bytes = |studio: &mut Studio| studio.world().resource::<FrustaStats>().uploaded_bytes;
    assert_eq!(bytes(&mut studio), 0);
    studio.world().entity_mut(bent).insert(pose(0.1));
    studio.headless.step();
    let moved = bytes(&mut studio);
    assert!(
        moved > 0 && moved <= 64 * segments,
        "{moved} bytes for {segments} segments"
    );
    // Once more, for it has come to rest, and then no more.
    studio.headless.step();
    assert!(bytes(&mut studio) <= 64 * segments);
    studio.headless.step();
    assert_eq!(bytes(&mut studio), 0);
    // Moving the whole plant is the transform's business.
    studio
        .world()
        .get_mut::<Transform>(still)
        .unwrap()
        .translation
        .x = 3.0;
    studio.headless.step();
    assert_eq!(bytes(&mut studio), 0);
}
