//! Which lighting a scene's lights call for.

use bevy::ecs::system::SystemParam;
use bevy::light::{
    Atmosphere, AtmosphereEnvironmentMapLight, DirectionalLightTexture,
    GeneratedEnvironmentMapLight, IrradianceVolume, RectLight,
};
use bevy::prelude::*;

use super::component::CrownLighting;

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
pub(crate) struct CrownLights<'w, 's> {
    rich: Query<'w, 's, (), Rich>,
}

impl CrownLights<'_, '_> {
    /// The lighting for crowns that are to have `wanted`.
    pub(crate) fn lighting(&self, wanted: CrownLighting) -> CrownLighting {
        if wanted == CrownLighting::Simple && !self.rich.is_empty() {
            CrownLighting::Full
        } else {
            wanted
        }
    }
}
