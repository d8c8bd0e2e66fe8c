use caustica_math::Transform;
use serde::{Deserialize, Serialize};

use super::Shape;
use crate::Origin;

/// The index of a group in [`super::Description::groups`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct GroupId(pub u32);

/// Shapes that are seen where the group has instances, and nowhere else. Memory holds them once. None of them may be a
/// lamp, and a group without shapes has no instances.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Group {
    /// A name for messages.
    pub name: String,
    /// The shapes, each with its own way into the group's frame.
    pub shapes: Vec<Shape>,
    /// Where it stands in the file.
    pub origin: Option<Origin>,
}

/// A place where a group is seen.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Instance {
    /// The group.
    pub group: GroupId,
    /// Group frame to world, without perspective. It may stretch and mirror: outside stays outside. One that cannot be
    /// inverted, or has factors beyond 10¹⁵, is an error.
    pub to_world: Transform,
    /// Where it stands in the file.
    pub origin: Option<Origin>,
}
