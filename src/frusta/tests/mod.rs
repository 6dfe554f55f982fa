//! What no app can bring about: plants for which there is no room.

mod room;
