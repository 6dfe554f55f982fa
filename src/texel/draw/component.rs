//! What a game's author puts on an entity.

use bevy::mesh::{MeshVertexAttribute, VertexFormat};
use bevy::prelude::*;

use super::super::asset::TexelVolume;
use super::super::choose::{AxisSlices, DrawnSlices, TexelQuality};
use super::super::facet::SurfaceFacets;
use super::geometry::facets;
use super::surface_mesh::TexelSurfaceError;
use crate::lighting::PlantLighting;

/// Height vectors of a mesh (§2.1): a mesh attribute, in the mesh's space, from each vertex to the top of the texels
/// there. Where a mesh has none, they are as long as a surface's [`thickness`](TexelSurface::thickness) and follow
/// the normals.
pub const ATTRIBUTE_HEIGHT_VECTOR: MeshVertexAttribute = MeshVertexAttribute::new(
    "Vertex_Height_Vector",
    0x5645_5244_5552_4503,
    VertexFormat::Float32x3,
);

/// Covers the mesh of the same entity with a volume: grass, fur, pebbles, a far forest.
///
/// The entity's [`Mesh3d`] says where: its triangles, the sides that carry texels turned counterclockwise to the eye; its
/// texture coordinates, of which each square from whole numbers to whole numbers is one texel; and its height vectors
/// ([`ATTRIBUTE_HEIGHT_VECTOR`]), or its normals. The mesh must be kept in the main world (as by
/// `RenderAssetUsages::default()`). It is drawn as ever, if it has a material; so give it the colour of the ground.
///
/// Triangles without area, there or in texture coordinates, and those with height vectors that are zero, lead through the
/// surface or cross, carry no texels, with a warning that names the first. A mesh that has no texture coordinates, no
/// triangles, or more of them than a storage buffer of the device holds (900,000 on any) carries none at all, with an error.
///
/// ```
/// # use bevy::prelude::*;
/// # use bevy_verdure::texel::*;
/// fn sow(mut commands: Commands, mut meshes: ResMut<Assets<Mesh>>, server: Res<AssetServer>) {
///     let lawn = Plane3d::default().mesh().size(4.0, 4.0).subdivisions(3).build();
///     commands.spawn((
///         Mesh3d(meshes.add(lawn)),
///         TexelSurface {
///             volume: server.load("grass.texel.ron"),
///             thickness: 0.3,
///         },
///     ));
/// }
/// ```
#[derive(Component, Clone, Debug, PartialEq, Reflect)]
#[reflect(Component, Clone, Debug, Default, PartialEq)]
#[require(TexelSettings, Transform, Visibility)]
pub struct TexelSurface {
    /// What it is covered with. Edits show in the frame after; one that is taken away stays until another is in its place.
    pub volume: Handle<TexelVolume>,
    /// Length of the height vectors where the mesh has none, in the mesh's units. Where it is not finite and above 0 the
    /// mesh carries no texels, with an error, even if it has height vectors.
    pub thickness: f32,
}

impl Default for TexelSurface {
    fn default() -> Self {
        Self {
            volume: Handle::default(),
            thickness: 1.0,
        }
    }
}

impl TexelSurface {
    /// The facets that carry its texels on a mesh, in the mesh's space, and those that carry none.
    ///
    /// # Errors
    /// When the mesh carries no texels at all.
    pub fn facets(&self, mesh: &Mesh) -> Result<SurfaceFacets, TexelSurfaceError> {
        facets(mesh, self.thickness, None, usize::MAX)
    }
}

/// Height vectors of one [`TexelSurface`], one for each vertex of its mesh, in the mesh's space: they take the place of
/// those of the mesh. Change them to move the texels, as a [`TexelBrush`](super::TexelBrush) does; they are uploaded in the
/// same frame, if that is before [`VerdureSystems::Attach`](crate::VerdureSystems::Attach).
///
/// If there are none, they follow the normals, [`thickness`](TexelSurface::thickness) long, whatever the mesh has; with any
/// other number than that of its vertices the surface carries no texels, or those of a skin stay as they were, with an
/// error.
#[derive(Component, Clone, Debug, Default, PartialEq, Reflect)]
#[reflect(Component, Clone, Debug, Default, PartialEq)]
pub struct TexelHeights(pub Vec<Vec3>);

/// Marks a [`TexelSurface`] whose mesh is changed in most frames, such as a flag: the mesh is read in every frame, so
/// that its texels do not lag one frame behind, as they do after a single edit.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Component, Clone, Debug, Default, PartialEq)]
pub struct LiveTexels;

/// Shows volumes one after the other on a [`TexelSurface`], as in a cartoon (§5). Volumes stay on the GPU as long as they
/// are named here; while one is not loaded yet, the one before it stays.
#[derive(Component, Clone, Debug, Default, PartialEq, Reflect)]
#[reflect(Component, Clone, Debug, Default, PartialEq)]
pub struct TexelCycle {
    /// The volumes, in order.
    pub volumes: Vec<Handle<TexelVolume>>,
    /// Volumes a second; backwards if negative.
    pub rate: f32,
}

impl TexelCycle {
    /// Which volume is shown at a time, in seconds; none if there is none, or the rate is no number.
    pub fn at(&self, seconds: f32) -> Option<&Handle<TexelVolume>> {
        let number = (seconds * self.rate).floor();
        let count = self.volumes.len() as f32;
        let index = number.rem_euclid(count);
        if index.is_finite() {
            self.volumes.get(index as usize)
        } else {
            None
        }
    }
}

/// How a [`TexelSurface`] is drawn. Filled in where it has none; may be changed at any time.
#[derive(Component, Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Component, Clone, Debug, Default, PartialEq)]
pub struct TexelSettings {
    /// What may be seen of slices; decides how many are drawn.
    pub quality: TexelQuality,
    /// The same for the views of lights, whose pixels are those of a shadow map. Its `direction` is not used.
    pub shadows: TexelQuality,
    /// Slices of a finer set among which, within the layer of a slice, is looked for what is seen of it: colours and light
    /// are nearly those of as many times more slices, outlines stay. From 1, the slice alone, to 16, rounded down to a power
    /// of two; others are taken for the nearest. Each doubling costs one look into a texture for a pixel.
    pub inner_slices: u32,
    /// The most slices a texel in any direction, rounded down to a power of two; 0 is taken for 1. Memory grows with it. A
    /// device has at most half as many as it has layers of a texture array; where that is fewer than the volume has voxels
    /// and than are asked for, a warning names the volume.
    pub most_slices: u32,
    /// Whether slices move apart where their number doubles, and directions fade into one another, pixel by pixel, as the
    /// view changes; else they pop.
    pub fade: bool,
    /// What lights the texels; [`Unlit`](PlantLighting::Unlit) ones have the colours of the volume.
    pub lighting: PlantLighting,
    /// Perceptual roughness, 0 to 1, as of Bevy's `StandardMaterial`. Only [`Full`](PlantLighting::Full) lighting heeds it.
    /// What is below or above is taken for the nearest, and no number for 0.
    pub roughness: f32,
    /// Reflectance, 0 to 1, as of Bevy's `StandardMaterial`. Only [`Full`](PlantLighting::Full) lighting heeds it. What is
    /// below or above is taken for the nearest, and no number for 0.
    pub reflectance: f32,
    /// Share of the light that comes through from behind, 0 to 1, as of Bevy's `StandardMaterial`: 0 is solid, 0.5 is grass
    /// and leaves, which look alike from both sides. What is below or above is taken for the nearest, and no number for 0.
    pub diffuse_transmission: f32,
    /// How far the top moves in the [`Wind`](crate::wind::Wind), in heights, for each metre a second: 0 is stiff, 0.03 is
    /// grass. Height vectors bend, and keep their length. What is no finite number is taken for 0. Facets of which the wind
    /// leads one through the surface, or across another, are not drawn as long as it does.
    pub flexibility: f32,
    /// Whether slices that show nothing are drawn all the same, for comparison.
    #[doc(hidden)]
    pub empty_slices: bool,
}

/// The most slices that are looked up in the layer of one.
const MOST_INNER_SLICES: u32 = 16;

/// Found on pears (§6, Figure 11), lit from all sides: with less single pixels are dark, with a half stalks cast no shadow
/// at their feet.
const SHADOW_SHARE: f32 = 0.125;

impl TexelSettings {
    /// Slices that are looked up in the layer of one of `count`, of which there are `most`: as the shader counts them.
    pub(crate) fn inner_slices(&self, count: u32, most: u32) -> u32 {
        let inner = self.inner_slices.clamp(1, MOST_INNER_SLICES);
        (most / count).clamp(1, 1 << inner.ilog2())
    }

    /// The same with 0 in place of what is no number, as it is taken for: so it is equal to itself.
    pub(crate) fn without_nan(mut self) -> Self {
        let numbers = [
            &mut self.roughness,
            &mut self.reflectance,
            &mut self.diffuse_transmission,
            &mut self.flexibility,
        ];
        let qualities = [&mut self.quality, &mut self.shadows];
        let of_qualities = qualities.into_iter().flat_map(|quality| {
            [
                &mut quality.depth,
                &mut quality.pixels,
                &mut quality.least_angle,
            ]
        });
        for number in numbers.into_iter().chain(of_qualities) {
            if number.is_nan() {
                *number = 0.0;
            }
        }
        self
    }

    /// [`flexibility`](Self::flexibility), of which what is no finite number is none.
    pub(crate) fn limited_flexibility(&self) -> f32 {
        if self.flexibility.is_finite() {
            self.flexibility
        } else {
            0.0
        }
    }

    /// How far above a place that is seen light falls on it, or solids would shade themselves in specks: as far as it may be
    /// from the surface, by slices, in whose layers inner ones are looked up, of a volume of which there are `most`. In
    /// shadow maps, merged layers stand out of what widens towards the light, by a share of d of [`shadows`](Self::shadows).
    pub(crate) fn stand_off(&self, slices: &AxisSlices, drawn: &DrawnSlices, most: u32) -> f32 {
        let count = 1u32 << slices.exponent;
        let inside = |doublings: u32| {
            slices.inside(doublings) / self.inner_slices(count << doublings, most) as f32
        };
        let inside = if drawn.count == count {
            inside(0)
        } else {
            // As deep as before where slices begin to move apart.
            inside(0).lerp(inside(1), drawn.apart)
        };
        // What is no number is none, and from e on there are gaps.
        let d = self.shadows.depth.clamp(0.0, 1.0).max(0.0) * slices.thickness;
        inside + SHADOW_SHARE * d
    }
}

impl Default for TexelSettings {
    fn default() -> Self {
        Self {
            quality: TexelQuality::default(),
            // No gaps, and no more: of what casts a shadow nobody sees the inside. The least angle is the usual one, for
            // slices that stand far apart along the light are as far above what they show, and would shade it in specks.
            shadows: TexelQuality {
                depth: 1.0,
                pixels: 2.0,
                ..Default::default()
            },
            inner_slices: 8,
            most_slices: 256,
            fade: true,
            lighting: PlantLighting::Simple,
            roughness: 0.8,
            reflectance: 0.3,
            diffuse_transmission: 0.0,
            flexibility: 0.0,
            empty_slices: false,
        }
    }
}

#[cfg(test)]
mod tests {
    use bevy::asset::uuid::Uuid;

    use super::super::super::axis::SliceAxis;
    use super::*;

    #[test]
    fn texels_that_bend_by_no_number_stand_still() {
        for (flexibility, expected) in [(0.03, 0.03), (f32::NAN, 0.0), (f32::INFINITY, 0.0)] {
            let settings = TexelSettings {
                flexibility,
                ..default()
            };
            assert_eq!(settings.limited_flexibility(), expected, "{flexibility}");
        }
    }

    #[test]
    fn light_falls_on_no_other_place_where_slices_begin_to_move_apart_and_where_they_end() {
        let settings = TexelSettings::default();
        let most = 64;
        let slices = |exponent: u32, finer: f32, step_aside: f32| AxisSlices {
            axis: SliceAxis::W,
            exponent,
            along: true,
            finer,
            lots: [0.0, 1.0],
            step_aside,
            thickness: 0.1,
            footprint: Vec2::ZERO,
        };
        let stand_off = |slices: AxisSlices| {
            let drawn = slices.drawn(true).expect("it has all lots");
            settings.stand_off(&slices, &drawn, most)
        };
        // From 4 on fewer than 8 are left to be looked up in the layer of one; from .1 on there are gaps.
        for exponent in 0..6 {
            for step_aside in [0.01, 0.15, 0.3] {
                let [before, begin, middle, end, after] = [
                    slices(exponent, 0.0, step_aside),
                    slices(exponent, 1e-6, step_aside),
                    slices(exponent, 0.5, step_aside),
                    slices(exponent, 1.0, step_aside),
                    slices(exponent + 1, 0.0, 0.5 * step_aside),
                ]
                .map(stand_off);
                assert!(
                    (before - begin).abs() <= 1e-5 * before,
                    "{exponent} {step_aside}"
                );
                assert!(
                    (end - after).abs() <= 1e-5 * after,
                    "{exponent} {step_aside}"
                );
                let mean = 0.5 * (begin + end);
                assert!(
                    (middle - mean).abs() <= 1e-5 * mean,
                    "{exponent} {step_aside}"
                );
            }
        }
    }

    #[test]
    fn volumes_come_one_after_the_other_and_again() {
        let volumes: Vec<_> = (0..3)
            .map(|i| Handle::Uuid(Uuid::from_u128(i), core::marker::PhantomData))
            .collect();
        let mut cycle = TexelCycle {
            volumes: volumes.clone(),
            rate: 2.0,
        };
        let shown = |cycle: &TexelCycle, seconds| cycle.at(seconds).cloned();
        for (seconds, index) in [(0.0, 0), (0.49, 0), (0.5, 1), (1.1, 2), (1.6, 0)] {
            assert_eq!(
                shown(&cycle, seconds),
                Some(volumes[index].clone()),
                "{seconds}"
            );
        }
        cycle.rate = -2.0;
        assert_eq!(shown(&cycle, 0.1), Some(volumes[2].clone()));
        cycle.rate = f32::NAN;
        assert_eq!(cycle.at(1.0), None);
        assert_eq!(TexelCycle::default().at(1.0), None);
    }
}
