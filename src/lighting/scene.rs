//! Which lighting a scene's lights call for.

use bevy::ecs::system::SystemParam;
use bevy::light::{
    Atmosphere, AtmosphereEnvironmentMapLight, DirectionalLightTexture,
    GeneratedEnvironmentMapLight, IrradianceVolume, RectLight,
};
use bevy::prelude::*;

use super::PlantLighting;

/// What simple lighting leaves out.
type Rich = Or<(
    With<PointLight>,
    With<SpotLight>,
    With<RectLight>,
    With<EnvironmentMapLight>,
    With<GeneratedEnvironmentMapLight>,
    With<AtmosphereEnvironmentMapLight>,
    With<IrradianceVolume>,
    With<DirectionalLightTexture>,
    With<Atmosphere>,
)>;

/// The lights of the scene, hidden ones included.
#[derive(SystemParam)]
pub(crate) struct SceneLights<'w, 's> {
    rich: Query<'w, 's, (), Rich>,
    suns: Query<'w, 's, (), With<DirectionalLight>>,
}

/// What lights plants in a scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct SceneLighting {
    pub(crate) lighting: PlantLighting,
    /// Whether there is more than one directional light, for which simple lighting needs a loop.
    pub(crate) more_suns: bool,
}

impl From<PlantLighting> for SceneLighting {
    fn from(lighting: PlantLighting) -> Self {
        Self {
            lighting,
            more_suns: false,
        }
    }
}

impl SceneLights<'_, '_> {
    /// The lighting for plants that are to have `wanted`.
    pub(crate) fn lighting(&self, wanted: PlantLighting) -> SceneLighting {
        match wanted {
            PlantLighting::Simple if self.rich.is_empty() => SceneLighting {
                lighting: wanted,
                more_suns: self.suns.iter().nth(1).is_some(),
            },
            PlantLighting::Simple => PlantLighting::Full.into(),
            PlantLighting::Full | PlantLighting::Unlit => wanted.into(),
        }
    }
}
