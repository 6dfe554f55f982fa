//! What the pipelines of all methods have in common.

use bevy::asset::AssetPath;
use bevy::render::render_resource::RenderPipelineDescriptor;
use bevy::shader::{ShaderDefVal, ShaderRef};

/// A shader of this crate, by its path below `src`.
pub(crate) fn embedded_shader(path: &str) -> ShaderRef {
    let path = format!("embedded://bevy_verdure/{path}");
    ShaderRef::Path(AssetPath::parse(&path).into_owned())
}

/// Defines names for both stages.
pub(crate) fn define(
    descriptor: &mut RenderPipelineDescriptor,
    defs: impl IntoIterator<Item = ShaderDefVal>,
) {
    for def in defs {
        descriptor.vertex.shader_defs.push(def.clone());
        if let Some(fragment) = &mut descriptor.fragment {
            fragment.shader_defs.push(def);
        }
    }
}

/// The names that are set.
pub(crate) fn names<const N: usize>(
    all: [(bool, &'static str); N],
) -> impl Iterator<Item = ShaderDefVal> {
    let set = all.into_iter().filter(|(set, _)| *set);
    set.map(|(_, name)| name.into())
}
