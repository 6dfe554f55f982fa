//! The crown of the grove's tree, ready to be baked.

use bevy::math::Mat4;

use crate::plants::BroadleafMeshes;
use crate::slicing::{BakeError, CrownMaterial, CrownMesh};

/// Twigs and leaves of a tree, as a crown.
///
/// # Errors
/// None for meshes as [`Broadleaf::grow`](crate::plants::Broadleaf::grow) makes them; for others as
/// [`CrownMesh::add_mesh`] says.
pub fn broadleaf_crown(tree: &BroadleafMeshes) -> Result<CrownMesh, BakeError> {
    let mut crown = CrownMesh::default();
    let material = crown.add_material(CrownMaterial::default());
    for (name, mesh) in [("twigs", &tree.twigs), ("leaves", &tree.leaves)] {
        crown.add_mesh(name, mesh, Mat4::IDENTITY, material)?;
    }
    Ok(crown)
}
