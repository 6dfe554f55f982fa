//! Where the time goes: a grove with one thing after the other left out.

use bevy_verdure::lab::charts::Chart;
use bevy_verdure::prelude::*;

use super::cost::{Way, costs};
use super::lab::{Drawn, Lab};

pub fn against_trees(lab: &mut Lab) -> Result<Chart, String> {
    let slicing = lab.bake(&BakeSettings::default())?;
    let lit = |lighting| {
        let settings = CrownSettings {
            lighting,
            ..CrownSettings::default()
        };
        Drawn::Slicing(slicing.clone(), settings)
    };
    let ways: [Way; 7] = [
        ("mesh".into(), Drawn::Mesh, true),
        ("mesh, no shadows cast".into(), Drawn::Mesh, false),
        ("full light".into(), lit(PlantLighting::Full), true),
        ("simple light".into(), lit(PlantLighting::Simple), true),
        ("unlit".into(), lit(PlantLighting::Unlit), true),
        (
            "simple light, no shadows cast".into(),
            lit(PlantLighting::Simple),
            false,
        ),
        (
            "unlit, no shadows cast".into(),
            lit(PlantLighting::Unlit),
            false,
        ),
    ];
    costs(
        lab,
        "Where the time of a grove goes, 640 x 480",
        &[1, 16, 128],
        &ways,
    )
}
