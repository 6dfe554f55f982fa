//! Maps and settings in the render world.

use std::sync::{Arc, OnceLock};

use bevy::asset::AssetId;
use bevy::image::Image;
use bevy::platform::collections::HashMap;
use bevy::prelude::*;
use bevy::render::Extract;
use bevy::render::render_resource::{
    AddressMode, BindGroupLayoutEntry, BindingType, BufferBindingType, BufferInitDescriptor,
    BufferUsages, Extent3d, FilterMode, MipmapFilterMode, OwnedBindingResource, Sampler,
    SamplerBindingType, SamplerDescriptor, ShaderStages, TextureDataOrder, TextureDescriptor,
    TextureDimension, TextureFormat, TextureSampleType, TextureUsages, TextureView,
    TextureViewDescriptor, TextureViewDimension,
};
use bevy::render::renderer::{RenderDevice, RenderQueue};
use bytemuck::{Pod, Zeroable};

use super::ceilings::{ceilings, first_ceilings};
use super::library::ReliefMaps;
use super::map::ReliefMap;
use super::settings::{Relief, ReliefMarch, ReliefSteps, ReliefThickness};

/// The textures of all relief maps in use. Lives in the render world.
#[derive(Resource, Default)]
pub struct ReliefTextures {
    /// What materials without relief are given.
    flat: Option<ReliefTexture>,
    sampler: Option<Sampler>,
    by_image: HashMap<AssetId<Image>, ReliefTexture>,
}

struct ReliefTexture {
    version: u32,
    map: Arc<ReliefMap>,
    view: TextureView,
    /// The heights in red and the ceilings in green, once a material leaps.
    with_ceilings: OnceLock<TextureView>,
}

/// Greatest number of steps, of halvings, and of steps towards the light that a setting may ask for.
const MOST_STEPS: u32 = 1024;
const MOST_BISECTIONS: u32 = 16;
const MOST_SELF_SHADOW: u32 = 64;

/// The settings of one material, as `shaders/shell_radii.wgsl` has them.
#[derive(Clone, Copy, Default, Pod, Zeroable)]
#[repr(C)]
struct ReliefUniform {
    metres: f32,
    share: f32,
    level: f32,
    /// 0 for as many as the shell needs on screen.
    steps: u32,
    /// Least and greatest height of the map.
    range: [f32; 2],
    /// Pixels of the map.
    size: [f32; 2],
    bisections: u32,
    self_shadow: u32,
    unused: [u32; 2],
    /// Where the ceilings of each mip level begin.
    ceilings: [u32; 16],
}

/// What a material binds for relief.
pub(crate) struct ReliefBindings;

impl ReliefBindings {
    /// Bindings after `first` that [`entries`](Self::entries) lays out.
    pub(crate) const COUNT: u32 = 3;

    /// The layout, from binding `first` on.
    pub(crate) fn entries(first: u32) -> [BindGroupLayoutEntry; Self::COUNT as usize] {
        let visibility = ShaderStages::VERTEX_FRAGMENT;
        let entry = |binding, visibility, ty| BindGroupLayoutEntry {
            binding,
            visibility,
            ty,
            count: None,
        };
        [
            entry(
                first,
                visibility,
                BindingType::Buffer {
                    ty: BufferBindingType::Uniform,
                    has_dynamic_offset: false,
                    min_binding_size: None,
                },
            ),
            entry(
                first + 1,
                ShaderStages::FRAGMENT,
                BindingType::Texture {
                    sample_type: TextureSampleType::Float { filterable: true },
                    view_dimension: TextureViewDimension::D2,
                    multisampled: false,
                },
            ),
            entry(
                first + 2,
                ShaderStages::FRAGMENT,
                BindingType::Sampler(SamplerBindingType::Filtering),
            ),
        ]
    }

    /// The resources of a material in the order of the layout; `None` while its map is not there yet.
    pub(crate) fn resources(
        relief: Option<&Relief>,
        textures: &ReliefTextures,
        device: &RenderDevice,
        queue: &RenderQueue,
    ) -> Option<[OwnedBindingResource; Self::COUNT as usize]> {
        let texture = match relief {
            Some(relief) => textures.by_image.get(&relief.map.id())?,
            None => textures.flat.as_ref()?,
        };
        let leaps = relief.is_some_and(|relief| relief.march == ReliefMarch::Leaping);
        let view = if leaps {
            let made = || heights_and_ceilings(&texture.map, device, queue);
            texture.with_ceilings.get_or_init(made)
        } else {
            &texture.view
        };
        let uniform = relief.map_or_else(ReliefUniform::default, |relief| uniform(relief, texture));
        let buffer = device.create_buffer_with_data(&BufferInitDescriptor {
            label: Some("frusta_relief"),
            contents: bytemuck::bytes_of(&uniform),
            usage: BufferUsages::UNIFORM,
        });
        Some([
            OwnedBindingResource::Buffer(buffer),
            OwnedBindingResource::TextureView(TextureViewDimension::D2, view.clone()),
            OwnedBindingResource::Sampler(
                SamplerBindingType::Filtering,
                textures.sampler.as_ref()?.clone(),
            ),
        ])
    }
}

fn uniform(relief: &Relief, texture: &ReliefTexture) -> ReliefUniform {
    let (metres, share) = match relief.thickness {
        ReliefThickness::Metres(h) => (h, 0.0),
        ReliefThickness::Relative(share) => (0.0, share),
    };
    ReliefUniform {
        metres,
        share,
        // NaN becomes 0.
        level: if relief.level > 0.0 {
            relief.level.min(1.0)
        } else {
            0.0
        },
        steps: match relief.steps {
            ReliefSteps::Auto => 0,
            ReliefSteps::Fixed(steps) => steps.clamp(1, MOST_STEPS),
        },
        // A level map has a shell of one level, at the foot of which it is.
        range: {
            let [low, high] = texture.map.range.map(f32::from);
            [low / 255.0, high.max(low + 1.0) / 255.0]
        },
        size: texture.map.size.map(|side| side as f32),
        bisections: relief.bisections.min(MOST_BISECTIONS),
        self_shadow: relief.self_shadow.min(MOST_SELF_SHADOW),
        unused: [0; 2],
        ceilings: first_ceilings(texture.map.size),
    }
}

/// Brings the textures up to date with the maps.
pub(crate) fn upload(
    mut textures: ResMut<ReliefTextures>,
    maps: Extract<Res<ReliefMaps>>,
    device: Res<RenderDevice>,
    queue: Res<RenderQueue>,
) {
    if textures.flat.is_none() {
        textures.flat = Some(texture(Arc::new(ReliefMap::flat()), 0, &device, &queue));
        textures.sampler = Some(device.create_sampler(&SamplerDescriptor {
            label: Some("frusta_relief"),
            address_mode_u: AddressMode::Repeat,
            address_mode_v: AddressMode::Repeat,
            mag_filter: FilterMode::Linear,
            min_filter: FilterMode::Linear,
            mipmap_filter: MipmapFilterMode::Linear,
            ..default()
        }));
    } else if !maps.is_changed() {
        return;
    }
    let textures = textures.as_mut();
    let mut kept = HashMap::default();
    for (id, entry) in maps.iter() {
        let known = textures.by_image.remove(id);
        let texture = match known {
            Some(known) if known.version == entry.version => known,
            _ => texture(entry.map.clone(), entry.version, &device, &queue),
        };
        kept.insert(*id, texture);
    }
    textures.by_image = kept;
}

fn texture(
    map: Arc<ReliefMap>,
    version: u32,
    device: &RenderDevice,
    queue: &RenderQueue,
) -> ReliefTexture {
    let heights = map.levels.concat();
    let view = view(&map, TextureFormat::R8Unorm, &heights, device, queue);
    ReliefTexture {
        version,
        map,
        view,
        with_ceilings: OnceLock::new(),
    }
}

fn heights_and_ceilings(
    map: &ReliefMap,
    device: &RenderDevice,
    queue: &RenderQueue,
) -> TextureView {
    let mut pixels: Vec<[u8; 2]> = (map.levels.concat().into_iter())
        .map(|height| [height, 0])
        .collect();
    for (pixel, ceiling) in pixels.iter_mut().zip(ceilings(map).concat()) {
        pixel[1] = ceiling;
    }
    let pixels = pixels.as_flattened();
    view(map, TextureFormat::Rg8Unorm, pixels, device, queue)
}

/// A texture of all of a map's levels.
fn view(
    map: &ReliefMap,
    format: TextureFormat,
    pixels: &[u8],
    device: &RenderDevice,
    queue: &RenderQueue,
) -> TextureView {
    let [width, height] = map.size;
    let texture = device.create_texture_with_data(
        queue,
        &TextureDescriptor {
            label: Some("frusta_relief"),
            size: Extent3d {
                width,
                height,
                depth_or_array_layers: 1,
            },
            mip_level_count: map.levels.len() as u32,
            sample_count: 1,
            dimension: TextureDimension::D2,
            format,
            usage: TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST,
            view_formats: &[],
        },
        TextureDataOrder::MipMajor,
        pixels,
    );
    texture.create_view(&TextureViewDescriptor::default())
}
