//! Letting what draws a part of something have the components of the whole.

use bevy::prelude::*;

/// Gives an entity a component, or takes it.
pub(crate) fn give_or_take<C: Component>(entity: &mut EntityCommands, component: Option<C>) {
    match component {
        Some(component) => entity.try_insert(component),
        None => entity.try_remove::<C>(),
    };
}
