//! Tests of the house itself: floors and circles of the sources, the names of types, the published schemas, the names at
//! the root of the library.

mod circles;
pub(crate) mod floors;
mod front_door;
mod names;
mod schema;
