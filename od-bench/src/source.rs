//! Source of the dictionary of a device.

#[cfg(feature = "eds")]
use std::sync::Arc;

#[cfg(feature = "eds")]
use od_eds::Tables;
use od_model::Dictionary;
use od_runtime::Device;

/// A dictionary and its tables, if they are not compiled in; copies of a device share them.
#[derive(Clone)]
pub(super) enum Source {
    Compiled(Dictionary<'static>),
    #[cfg(feature = "eds")]
    Loaded(Arc<Tables>),
}

impl Source {
    /// The dictionary that the compiler knows of a device.
    pub(super) const fn of<D: Device>() -> Self {
        Self::Compiled(const { D::DICTIONARY.expect("the node's type has no dictionary") })
    }

    pub(super) fn dictionary(&self) -> Dictionary<'_> {
        match self {
            Self::Compiled(dictionary) => *dictionary,
            #[cfg(feature = "eds")]
            Self::Loaded(tables) => tables.dictionary(),
        }
    }
}
