//! Access to a value from the bus, and the parameter group that saves it (CiA 306-1; CiA 301, object 1010h).

use core::fmt;

/// Access types of CiA 306-1, seen from the bus.
///
/// ```
/// use od_model::Access;
///
/// assert!(Access::Rw.readable() && Access::Rw.writable());
/// assert!(Access::Rww.maps_to_rpdo() && !Access::Rww.maps_to_tpdo());
/// assert_eq!(Access::Const.name(), "const");
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub enum Access {
    /// Read only on the bus; the device changes it.
    #[default]
    Ro,
    /// Write only on the bus.
    Wo,
    /// Read and write.
    Rw,
    /// Read and write, mappable into a TPDO only.
    Rwr,
    /// Read and write, mappable into an RPDO only.
    Rww,
    /// Read only, and never changed by the device either.
    Const,
}

impl Access {
    /// All access types.
    pub const ALL: [Self; 6] = [
        Self::Ro,
        Self::Wo,
        Self::Rw,
        Self::Rwr,
        Self::Rww,
        Self::Const,
    ];

    /// Returns the spelling in an EDS: `ro`, `wo`, `rw`, `rwr`, `rww`, `const`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Ro => "ro",
            Self::Wo => "wo",
            Self::Rw => "rw",
            Self::Rwr => "rwr",
            Self::Rww => "rww",
            Self::Const => "const",
        }
    }

    /// Returns whether a master may read the value.
    pub const fn readable(self) -> bool {
        !matches!(self, Self::Wo)
    }

    /// Returns whether a master may write the value.
    pub const fn writable(self) -> bool {
        !matches!(self, Self::Ro | Self::Const)
    }

    /// Returns whether the value may be mapped into a TPDO if its object is mappable (CiA 306-1).
    pub const fn maps_to_tpdo(self) -> bool {
        matches!(self, Self::Ro | Self::Rw | Self::Rwr | Self::Const)
    }

    /// Returns whether the value may be mapped into an RPDO if its object is mappable (CiA 306-1).
    pub const fn maps_to_rpdo(self) -> bool {
        matches!(self, Self::Wo | Self::Rw | Self::Rww)
    }
}

impl fmt::Display for Access {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// Group of values that one save and restore sub-index of 1010h/1011h covers.
///
/// CiA 301, objects 1010h and 1011h: sub-index 1 covers all groups, 2 the
/// communication, 3 the application, 4 the manufacturer parameters.
///
/// ```
/// use od_model::Group;
///
/// assert_eq!(Group::of_index(0x1017), Group::Communication);
/// // 1010h:02 saves the communication parameters.
/// assert!(Group::Communication.covered_by(2) && !Group::Application.covered_by(2));
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub enum Group {
    /// Not saved.
    #[default]
    None,
    /// 1010h:02, objects 1000h–1FFFh unless the description says otherwise.
    Communication,
    /// 1010h:03, objects 6000h–9FFFh unless the description says otherwise.
    Application,
    /// 1010h:04, objects 2000h–5FFFh unless the description says otherwise.
    Manufacturer,
}

impl Group {
    /// Returns the group of an object by its index.
    pub const fn of_index(index: u16) -> Self {
        match index >> 12 {
            1 => Self::Communication,
            2..=5 => Self::Manufacturer,
            6..=9 => Self::Application,
            _ => Self::None,
        }
    }

    /// Returns the group's name; `None` for a value that is not saved.
    pub const fn name(self) -> Option<&'static str> {
        match self {
            Self::None => None,
            Self::Communication => Some("communication"),
            Self::Application => Some("application"),
            Self::Manufacturer => Some("manufacturer"),
        }
    }

    /// Returns whether sub-index `sub` of 1010h or 1011h covers this group.
    pub const fn covered_by(self, sub: u8) -> bool {
        let own = self as u8 + 1;
        own > 1 && (sub == 1 || sub == own)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_follow_the_index() {
        assert_eq!(Group::of_index(0x1017), Group::Communication);
        assert_eq!(Group::of_index(0x2101), Group::Manufacturer);
        assert_eq!(Group::of_index(0x6003), Group::Application);
        assert!(Group::Application.covered_by(1) && Group::Application.covered_by(3));
        assert!(!Group::Application.covered_by(2) && !Group::None.covered_by(1));
    }
}
