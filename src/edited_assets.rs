//! Assets in use that have become others: edited, reloaded, or taken away and put back.
//!
//! To put one back is to Bevy as if it came for the first time. Until then what was made of it stays.

use bevy::asset::{Asset, AssetEvent, AssetId};
use bevy::ecs::system::SystemParam;
use bevy::platform::collections::HashSet;
use bevy::prelude::*;

/// What has become of the assets of a kind since a system last looked.
#[derive(SystemParam)]
pub(crate) struct EditedAssets<'w, 's, A: Asset> {
    events: MessageReader<'w, 's, AssetEvent<A>>,
    /// Those in use of which there is none now.
    gone: Local<'s, HashSet<AssetId<A>>>,
    /// Those in use that are others than before.
    pub edited: Local<'s, HashSet<AssetId<A>>>,
    /// Those in use that were taken away just now.
    pub removed: Local<'s, HashSet<AssetId<A>>>,
}

impl<A: Asset> EditedAssets<'_, '_, A> {
    /// Looks at what has become of those that are used. What comes for the first time is not edited, though it may be in use
    /// already, in the frame before that is told.
    pub(crate) fn look(&mut self, is_used: impl Fn(AssetId<A>) -> bool) {
        self.gone.retain(|id| is_used(*id));
        self.edited.clear();
        self.removed.clear();
        for event in self.events.read() {
            match event {
                AssetEvent::Modified { id } if is_used(*id) => {
                    self.edited.insert(*id);
                }
                AssetEvent::Removed { id } if is_used(*id) => {
                    self.gone.insert(*id);
                    self.removed.insert(*id);
                }
                AssetEvent::Added { id } if self.gone.remove(id) => {
                    self.edited.insert(*id);
                }
                _ => {}
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use bevy::asset::AssetPlugin;
    use bevy::ecs::system::SystemState;

    use super::*;

    #[derive(Asset, TypePath)]
    struct Leaf;

    #[test]
    fn what_is_edited_or_put_back_is_told_once_and_what_is_new_or_unused_never() {
        let mut app = App::new();
        app.add_plugins((TaskPoolPlugin::default(), AssetPlugin::default()));
        app.init_asset::<Leaf>();
        let mut state = SystemState::<EditedAssets<Leaf>>::new(app.world_mut());
        let mut leaves = app.world_mut().resource_mut::<Assets<Leaf>>();
        let [used, unused] = [leaves.add(Leaf), leaves.add(Leaf)];
        let mut told = |change: &dyn Fn(&mut Assets<Leaf>, &Handle<Leaf>)| {
            for leaf in [&used, &unused] {
                change(&mut app.world_mut().resource_mut::<Assets<Leaf>>(), leaf);
            }
            app.update();
            let mut edits = state.get_mut(app.world_mut()).expect("assets are there");
            edits.look(|id| id == used.id());
            assert!(!edits.edited.contains(&unused.id()) && !edits.removed.contains(&unused.id()));
            [edits.edited.len(), edits.removed.len()]
        };
        let take = |leaves: &mut Assets<Leaf>, leaf: &Handle<Leaf>| {
            leaves.remove(leaf);
        };
        let put = |leaves: &mut Assets<Leaf>, leaf: &Handle<Leaf>| {
            leaves.insert(leaf, Leaf).expect("its handle is in use");
        };
        assert_eq!(told(&|_, _| {}), [0, 0], "new");
        assert_eq!(told(&put), [1, 0], "replaced");
        assert_eq!(told(&take), [0, 1], "taken away");
        assert_eq!(told(&|_, _| {}), [0, 0]);
        assert_eq!(told(&put), [1, 0], "put back");
        let exchange = |leaves: &mut Assets<Leaf>, leaf: &Handle<Leaf>| {
            take(leaves, leaf);
            put(leaves, leaf);
        };
        assert_eq!(told(&exchange), [1, 1], "exchanged");
    }
}
