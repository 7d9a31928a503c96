//! The device of a bench's node: its dictionary, compiled or of a file, and its family.

#[cfg(feature = "eds")]
use std::sync::Arc;

#[cfg(feature = "eds")]
use od_eds::Tables;
use od_model::Dictionary;
use od_runtime::rooms::{LoadedRooms, LoadedValues};
use od_runtime::{Device, Profile, Services};

/// A dictionary and its tables, if they are not compiled in; copies of a device share them.
#[derive(Clone)]
pub(crate) enum Source {
    Compiled(Dictionary<'static>),
    #[cfg(feature = "eds")]
    Loaded(Arc<Tables>),
}

impl Source {
    pub(crate) fn dictionary(&self) -> Dictionary<'_> {
        match self {
            Self::Compiled(dictionary) => *dictionary,
            #[cfg(feature = "eds")]
            Self::Loaded(tables) => tables.dictionary(),
        }
    }
}

/// A device whose dictionary is known at run time, with every service.
#[derive(Clone)]
pub(crate) struct Loaded {
    pub(crate) source: Source,
    pub(crate) profile: Profile,
}

impl Services for Loaded {
    const SERVERS: bool = true;
    const SYNC_PRODUCER: bool = true;
    const TIME: bool = true;
}

impl Device for Loaded {
    type Values = LoadedValues;
    type Rooms = LoadedRooms;

    fn dictionary(&self) -> Dictionary<'_> {
        self.source.dictionary()
    }

    fn profile(&self) -> &Profile {
        &self.profile
    }
}
