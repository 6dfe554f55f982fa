//! The textures of a glTF model.

use gltf::image::Source;

use super::{Model, beside};
use crate::slicing::CrownTexture;

impl Model<'_> {
    /// That of the base colour, if it has one.
    pub(super) fn texture(
        &self,
        material: &gltf::Material,
    ) -> Result<Option<CrownTexture>, String> {
        let Some(texture) = material.pbr_metallic_roughness().base_color_texture() else {
            return Ok(None);
        };
        let source = texture.texture().source();
        let (name, bytes) = match source.source() {
            Source::Uri { uri, .. } => (uri.to_string(), beside(self.path, uri)?),
            Source::View { view, .. } => {
                let name = format!("image {}", source.index());
                let buffer = self.buffers.get(view.buffer().index());
                let bytes =
                    buffer.and_then(|buffer| buffer.get(view.offset()..)?.get(..view.length()));
                let bytes = bytes
                    .ok_or_else(|| format!("{name} lies outside of its buffer: export it anew"))?;
                (name, bytes.to_vec())
            }
        };
        let image = image::load_from_memory_with_format(&bytes, image::ImageFormat::Png)
            .map_err(|error| {
                format!("{name}: {error} Textures must be PNGs: export it anew with PNG")
            })?
            .into_rgba8();
        let size = [image.width(), image.height()];
        let pixels = image.pixels().map(|pixel| pixel.0).collect();
        CrownTexture::new(size, pixels)
            .map(Some)
            .map_err(|error| error.to_string())
    }
}
