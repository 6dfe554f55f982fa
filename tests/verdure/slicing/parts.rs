//! The discrepancy angle part by part, up close (§4): what changes from frame to frame, and whether it is nearer to the
//! mesh.

use bevy::prelude::*;
use bevy_verdure::lab::{Lens, Shot, Studio, mean_flip};
use bevy_verdure::prelude::*;
use bevy_verdure::slicing::blend::PARTS;

use super::{CROWN, SIZE, UNLIT, eye, plant, plant_mesh, studio};
use crate::jumps::jumps;

const SKY: Color = Color::srgb(0.6, 0.8, 1.0);

const WHOLE: CrownSettings = CrownSettings {
    discrepancy: DiscrepancyAngle::PerCrown,
    ..UNLIT
};

/// A shot of all of the crown, 6.5 m wide, from so many metres away.
fn filled(azimuth: f32, elevation: f32, distance: f32) -> Shot {
    Shot {
        eye: eye(azimuth, elevation, distance),
        at: CROWN.shape().centroid,
        lens: Lens::Perspective(2.0 * (3.25 / distance).min(0.99).asin()),
        size: SIZE,
    }
}

#[test]
fn nothing_pops_on_orbits_near_by_nor_where_parts_get_angles_of_their_own() {
    let (mut studio, _) = studio(UNLIT);
    let mut check = |name: &str, shots: &mut dyn Iterator<Item = Shot>| {
        let (largest, median) = jumps(shots.map(|shot| studio.photograph(&shot, SKY)));
        println!("{name}: largest {largest:.4}, median {median:.4}");
        // The target of a slow orbit.
        assert!(largest <= 1.5 * median, "{name}: {largest} {median}");
    };
    // Past the swap, an orientation, up past level with the crown, and on to where the vertical slicing is alone.
    for distance in [3.5, 5.0, 8.0] {
        for middle in [0.0, 30.0] {
            let turn = |i: i32| filled(middle + 0.25 * (i as f32 + 0.5), 4.0, distance);
            check(
                &format!("{distance} m, {middle}°"),
                &mut (-12..12).map(turn),
            );
        }
        let rise = |i: i32| filled(20.0, 0.5 * (i as f32 + 0.5), distance);
        check(&format!("{distance} m, rising"), &mut (-4..16).map(rise));
        let above = format!("{distance} m, rising to 62°");
        check(&above, &mut (56..124).map(rise));
    }
    // Where the pipeline of its own takes over.
    let edge = PARTS[1] * CROWN.shape().radius;
    let walk = |i: i32| filled(20.0, 4.0, edge - 0.05 * (i as f32 + 0.5));
    check("walk", &mut (-10..10).map(walk));
}

#[test]
fn near_by_a_crown_is_nearer_to_its_mesh_part_by_part_than_whole_and_from_far_the_same() {
    let mut studio = Studio::default();
    let near = [5.0, 7.0].map(|distance| filled(30.0, 0.0, distance));
    let far = filled(30.0, 0.0, 1.01 * PARTS[1] * CROWN.shape().radius);
    let mesh = plant_mesh(&mut studio, Transform::IDENTITY, true);
    studio.headless.step();
    let references = near.map(|shot| studio.photograph(&shot, SKY).rgb_bytes());
    for part in mesh {
        studio.world().despawn(part);
    }
    let [part, whole] = [UNLIT, WHOLE].map(|settings| {
        let crown = plant(&mut studio, settings, Transform::IDENTITY);
        studio.headless.step();
        let errors = [0, 1].map(|i| {
            let seen = studio.photograph(&near[i], SKY).rgb_bytes();
            mean_flip((SIZE.x, SIZE.y), &references[i], &seen)
        });
        let far = studio.photograph(&far, SKY).rgb_bytes();
        studio.world().despawn(crown);
        (errors, far)
    });
    println!("{:?} {:?}", part.0, whole.0);
    for (part, whole) in part.0.into_iter().zip(whole.0) {
        assert!(part < whole, "{part} {whole}");
    }
    assert!(part.1 == whole.1, "from far both are one");
}
