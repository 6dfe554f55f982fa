//! Baked light, as the paper has it (§3.1, §3.3): colours are shaded once, by light that turns with the surface.
//!
//! The crate lights volumes by the scene instead, with their normals. Baking is for comparison, and for materials
//! without lighting.

use bevy::math::Vec3;

use super::color::{SrgbTable, decode_normal};
use super::parallel;
use super::volume::ReferenceVolume;

/// One distant light and its reflection after B. T. Phong, *Illumination for Computer Generated Pictures*, 1975.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BakedLight {
    /// Where the light comes from, in metres of the volume's box, of any length.
    pub from: Vec3,
    /// Where the eye is taken to be, likewise.
    pub eye: Vec3,
    /// Share of the colour that shows without light, linear.
    pub ambient: f32,
    /// Share of the colour that shows where light falls straight.
    pub diffuse: f32,
    /// Strength of the highlight, which is white.
    pub specular: f32,
    /// The highlight's exponent.
    pub shininess: f32,
}

impl Default for BakedLight {
    /// From the upper left, matt, seen from above.
    fn default() -> Self {
        Self {
            from: Vec3::new(-0.5, 0.4, 0.8),
            eye: Vec3::Z,
            ambient: 0.25,
            diffuse: 0.75,
            specular: 0.0,
            shininess: 16.0,
        }
    }
}

impl BakedLight {
    /// The linear colour that a surface of a colour and a unit normal shows. A zero `from` or `eye` lights nothing.
    pub fn shade(&self, color: Vec3, normal: Vec3) -> Vec3 {
        let from = self.from.normalize_or_zero();
        let cosine = normal.dot(from);
        let mirrored = 2.0 * cosine * normal - from;
        let lobe = mirrored.dot(self.eye.normalize_or_zero()).max(0.0);
        let highlight = if cosine > 0.0 && self.specular > 0.0 {
            self.specular * lobe.powf(self.shininess)
        } else {
            0.0
        };
        color * (self.ambient + self.diffuse * cosine.max(0.0)) + highlight
    }
}

impl ReferenceVolume {
    /// The same volume with colours that light has shaded. Normals stay as they are.
    pub fn baked(&self, light: &BakedLight) -> Self {
        let table = SrgbTable::new();
        let layer = (self.size().x * self.size().y) as usize;
        let mut colors = self.colors().to_vec();
        parallel::for_each_chunk(&mut colors, layer, |z, colors| {
            let normals = &self.normals()[z * layer..];
            for (color, [x, y, z, _]) in colors.iter_mut().zip(normals) {
                if let [r, g, b, 255] = *color {
                    let shaded = light.shade(table.decode([r, g, b]), decode_normal([*x, *y, *z]));
                    let [r, g, b] = table.encode(shaded);
                    *color = [r, g, b, 255];
                }
            }
        });
        self.with_colors(colors)
    }
}

#[cfg(test)]
mod tests {
    use bevy::math::UVec3;

    use super::super::build::{VolumeSettings, from_hypertexture};
    use super::super::progress::silent;
    use super::*;

    #[test]
    fn light_falls_by_the_cosine_and_shines_in_the_mirror() {
        let light = BakedLight {
            from: Vec3::new(0.0, 2.0, 2.0),
            eye: Vec3::new(0.0, -3.0, 3.0),
            specular: 0.5,
            ..BakedLight::default()
        };
        let color = Vec3::new(0.2, 0.4, 0.6);
        // The eye is where the light is mirrored to.
        let up = light.shade(color, Vec3::Z);
        let expected = color * (0.25 + 0.75 * 0.5f32.sqrt()) + 0.5;
        assert!(up.distance(expected) < 1e-6, "{up}");
        assert_eq!(light.shade(color, Vec3::NEG_Z), color * 0.25);
    }

    #[test]
    fn a_baked_volume_has_the_same_voxels_in_other_colours() {
        let settings = VolumeSettings::new(UVec3::splat(8));
        let ball = |at: Vec3| (0.9 - at.distance(Vec3::splat(0.5)), Vec3::ONE);
        let volume = from_hypertexture(ball, &settings, &silent).unwrap().volume;
        let light = BakedLight {
            from: Vec3::Z,
            ..BakedLight::default()
        };
        let baked = volume.baked(&light);
        for (x, y, z) in (0..512).map(|i| (i % 8, i / 8 % 8, i / 64)) {
            assert_eq!(baked.is_opaque(x, y, z), volume.is_opaque(x, y, z));
        }
        assert_eq!(baked.normals(), volume.normals());
        let (top, bottom) = (baked.color(4, 4, 6)[0], baked.color(4, 4, 1)[0]);
        // A normal of (1, 1, 5)/√27 gets 0.97 of the light, 252 in sRGB, or a byte less for the bytes of normals; its
        // opposite the ambient quarter, 137.
        assert!(top.abs_diff(252) <= 1 && bottom == 137, "{top} {bottom}");
    }
}
