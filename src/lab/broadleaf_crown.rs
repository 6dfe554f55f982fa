//! The crown of the grove's tree, ready to be baked.

use bevy::math::Mat4;

use crate::plants::BroadleafMeshes;
use crate::slicing::{BakeError, CrownMaterial, CrownMesh};

/// Twigs and leaves of a tree, as a crown; through leaves comes this share of the light from behind.
///
/// # Errors
/// None for meshes as [`Broadleaf::grow`](crate::plants::Broadleaf::grow) makes them; for others as
/// [`CrownMesh::add_mesh`] says.
pub fn broadleaf_crown(
    tree: &BroadleafMeshes,
    diffuse_transmission: f32,
) -> Result<CrownMesh, BakeError> {
    let mut crown = CrownMesh::default();
    for (name, mesh, diffuse_transmission) in [
        ("twigs", &tree.twigs, 0.0),
        ("leaves", &tree.leaves, diffuse_transmission),
    ] {
        let material = crown.add_material(CrownMaterial {
            diffuse_transmission,
            ..CrownMaterial::default()
        });
        crown.add_mesh(name, mesh, Mat4::IDENTITY, material)?;
    }
    Ok(crown)
}
