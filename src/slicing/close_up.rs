//! Right up close a crown gives over to its mesh (§4: "one should resort to polygonal representations").

use core::ops::Range;

use bevy::camera::visibility::VisibilityRange;

/// For a crown whose mesh is at hand: the ranges of the mesh and of the [`SlicedCrown`](super::SlicedCrown), which fade into
/// one another while the eye comes from `margin.end` to `margin.start` metres from where both entities are: pixel by pixel,
/// each is of one or of the other, shadows too. Both entities must be at the same place. Metres are the world's; 8 to 12
/// suits a tree of the paper's, whose slices show from about 10 m on. A margin that is not finite, or starts above its end
/// or below 0, is cut to one that is.
///
/// ```
/// # use bevy::prelude::*;
/// # use bevy_verdure::slicing::*;
/// # fn plant(mut commands: Commands, oak: Handle<Slicing>, leaves: Handle<Mesh>, green: Handle<StandardMaterial>) {
/// let [near, far] = close_up(8.0..12.0);
/// let tree = (Transform::from_xyz(4.0, 0.0, 2.0), Visibility::default());
/// commands.spawn(tree).with_children(|tree| {
///     tree.spawn((SlicedCrown(oak), far));
///     tree.spawn((Mesh3d(leaves), MeshMaterial3d(green), near));
/// });
/// # }
/// ```
pub fn close_up(margin: Range<f32>) -> [VisibilityRange; 2] {
    let metres = |at: f32| if at.is_finite() { at.max(0.0) } else { 0.0 };
    let start = metres(margin.start);
    let margin = start..metres(margin.end).max(start);
    let near = VisibilityRange {
        start_margin: 0.0..0.0,
        end_margin: margin.clone(),
        use_aabb: false,
    };
    let far = VisibilityRange {
        start_margin: margin,
        end_margin: f32::MAX..f32::MAX,
        use_aabb: false,
    };
    [near, far]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mesh_and_crown_meet_in_one_margin_whatever_is_asked_for() {
        for (asked, margin) in [
            (8.0..12.0, 8.0..12.0),
            (12.0..8.0, 12.0..12.0),
            (-3.0..f32::NAN, 0.0..0.0),
        ] {
            let [near, far] = close_up(asked);
            assert_eq!(near.end_margin, margin);
            assert_eq!(far.start_margin, margin);
            assert!(near.start_margin.end <= margin.start && margin.end <= far.end_margin.start);
        }
    }
}
