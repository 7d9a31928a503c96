//! A device as the node uses it.

use od_model::Dictionary;

use crate::profile::Profile;
use crate::rooms::{Rooms, Values};
use crate::services::Services;

/// A device: its dictionary, its profile, and the memory that a node of it needs.
///
/// `object_dictionary!` implements this trait for the type `Device` of each module that it makes. A
/// host that loads dictionaries at run time has a type of its own:
///
/// ```
/// # #[cfg(feature = "std")] {
/// use od_model::Dictionary;
/// use od_runtime::rooms::{LoadedRooms, LoadedValues};
/// use od_runtime::{Device, Services};
///
/// struct Loaded(od_eds::Tables);
///
/// impl Services for Loaded {}
///
/// impl Device for Loaded {
///     type Values = LoadedValues;
///     type Rooms = LoadedRooms;
///
///     fn dictionary(&self) -> Dictionary<'_> {
///         self.0.dictionary()
///     }
/// }
/// # }
/// ```
pub trait Device: Services {
    /// The current values of a node of this device.
    type Values: Values;
    /// State of the services of a node of this device.
    type Rooms: Rooms;
    /// The dictionary; 1000h, 1001h and 1018h are mandatory (CiA 301, chapter 7.5.1).
    fn dictionary(&self) -> Dictionary<'_>;
    /// Options and deviations of the device family relative to CiA 301.
    #[inline]
    fn profile(&self) -> &Profile {
        &Profile::CIA301
    }
}
