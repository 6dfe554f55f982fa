//! The textures of a glTF model.

use bevy::asset::{Handle, RenderAssetUsages};
use bevy::image::Image;
use bevy::render::render_resource::{Extent3d, TextureDimension, TextureFormat};
use gltf::image::Source;

use super::{Reader, beside};

impl Reader<'_> {
    /// That of the base colour, if it has one. Each is read once.
    pub(super) fn texture(
        &mut self,
        material: &gltf::Material,
    ) -> Result<Option<Handle<Image>>, String> {
        let Some(texture) = material.pbr_metallic_roughness().base_color_texture() else {
            return Ok(None);
        };
        let source = texture.texture().source();
        if let Some(known) = self.textures.get(&source.index()) {
            return Ok(Some(known.clone()));
        }
        let image = self.picture(&source)?;
        let handle = self.model.images.add(image);
        self.textures.insert(source.index(), handle.clone());
        Ok(Some(handle))
    }

    fn picture(&self, source: &gltf::Image) -> Result<Image, String> {
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
        let pixels = image::load_from_memory_with_format(&bytes, image::ImageFormat::Png)
            .map_err(|error| {
                format!("{name}: {error} Textures must be PNGs: export it anew with PNG")
            })?
            .into_rgba8();
        let size = Extent3d {
            width: pixels.width(),
            height: pixels.height(),
            depth_or_array_layers: 1,
        };
        Ok(Image::new(
            size,
            TextureDimension::D2,
            pixels.into_raw(),
            TextureFormat::Rgba8UnormSrgb,
            RenderAssetUsages::MAIN_WORLD,
        ))
    }
}
