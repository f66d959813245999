//! The registered tasks and drives.

use opendr_engine::Result;
use opendr_engine::params::{ParamMap, Params};

use super::{BaseKind, MobileManipulation, MobileManipulationParams, Task};
use crate::Registration;
use crate::registration::checked;

/// Parameters of a task with its defaults.
trait Variant: Params {
    const ID: &'static str;
    const TASK: Task;

    fn params(self) -> MobileManipulationParams;
}

macro_rules! variants {
    ($($(#[$doc:meta])* $name:ident = $id:literal, $task:ident $(, $field:ident = $value:expr)?;)*) => {$(
        $(#[$doc])*
        #[derive(Debug, Clone, Params)]
        pub struct $name {
            /// Parameters of all tasks.
            #[param(flatten $(, $field = $value)?)]
            pub params: MobileManipulationParams,
        }

        impl Variant for $name {
            const ID: &'static str = $id;
            const TASK: Task = Task::$task;

            fn params(self) -> MobileManipulationParams {
                self.params
            }
        }
    )*};
}

variants! {
    /// `MobileManipReach-v1`: a random pose.
    OmniReach = "MobileManipReach-v1", Reach;
    /// `MobileManipPickPlace-v1`: an object from one table to another.
    OmniPickPlace = "MobileManipPickPlace-v1", PickPlace;
    /// `MobileManipDoor-v1`: a door of a cabinet.
    OmniDoor = "MobileManipDoor-v1", Door;
    /// `MobileManipDrawer-v1`: a drawer of a cabinet.
    OmniDrawer = "MobileManipDrawer-v1", Drawer;
    /// `MobileManipReach-diff-v1`: with a differential drive.
    DiffReach = "MobileManipReach-diff-v1", Reach, base = BaseKind::Diff;
    /// `MobileManipPickPlace-diff-v1`: with a differential drive.
    DiffPickPlace = "MobileManipPickPlace-diff-v1", PickPlace, base = BaseKind::Diff;
    /// `MobileManipDoor-diff-v1`: with a differential drive.
    DiffDoor = "MobileManipDoor-diff-v1", Door, base = BaseKind::Diff;
    /// `MobileManipDrawer-diff-v1`: with a differential drive.
    DiffDrawer = "MobileManipDrawer-diff-v1", Drawer, base = BaseKind::Diff;
}

/// Returns the entries of all tasks and drives.
pub(crate) fn registrations() -> [Registration; 8] {
    [
        registration::<OmniReach>(),
        registration::<OmniPickPlace>(),
        registration::<OmniDoor>(),
        registration::<OmniDrawer>(),
        registration::<DiffReach>(),
        registration::<DiffPickPlace>(),
        registration::<DiffDoor>(),
        registration::<DiffDrawer>(),
    ]
}

fn registration<V: Variant>() -> Registration {
    let make = |params: &ParamMap| -> Result<_> {
        checked(MobileManipulation::called(V::ID, V::TASK, &V::from_map(params)?.params())?)
    };
    Registration::new(V::ID, V::FIELDS, make)
}
