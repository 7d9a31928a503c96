//! Family of an encoder as a type: what the compiler knows of its profile.

use od_model::Address;

use super::object::Role;
use super::profile::EncoderProfile;

/// Properties of an encoder's family that are known at compile time, so that the compiler leaves out
/// what the family does not have.
///
/// ```
/// use od_runtime::encoder::{Angle, Encoder, EncoderProfile, Family, Sampled};
/// use od_runtime::Duration;
///
/// struct Thermal;
///
/// impl Family for Thermal {
///     const PROFILE: Option<&'static EncoderProfile> = Some(&EncoderProfile::CIA406);
/// }
///
/// let shaft = Sampled::<_, 16>::new(Angle::ZERO, Duration::from_millis(1));
/// let encoder: Encoder<_, Thermal> = Encoder::of_family(shaft);
/// assert_eq!(encoder.profile(), &EncoderProfile::CIA406);
/// ```
pub trait Family {
    /// Profile of the family; `None`: known at run time ([`Encoder::new`](super::Encoder::new)).
    const PROFILE: Option<&'static EncoderProfile>;
}

/// Family whose profile is known at run time only.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub struct AnyFamily;

impl Family for AnyFamily {
    const PROFILE: Option<&'static EncoderProfile> = None;
}

/// Roles that objects of a family may have, and its gear.
pub(super) struct Parts {
    pub(super) time_stamp: bool,
    pub(super) raw_position: bool,
    pub(super) diagnosis: bool,
    pub(super) movement: bool,
    pub(super) injected_error: bool,
    pub(super) injected_offset: bool,
    pub(super) gear: bool,
}

impl Parts {
    /// Those of a family, as far as the compiler knows.
    pub(super) const fn of<F: Family>() -> Self {
        let Some(profile) = F::PROFILE else {
            return Self::all(true);
        };
        let mut parts = Self {
            gear: profile.gear.is_some(),
            ..Self::all(false)
        };
        let mut rest: &[(Address, Role)] = profile.objects;
        while let [(_, role), others @ ..] = rest {
            match role {
                Role::TimeStamp => parts.time_stamp = true,
                Role::RawPosition => parts.raw_position = true,
                Role::Diagnosis(_) => parts.diagnosis = true,
                Role::Movement(_) => parts.movement = true,
                Role::InjectedError => parts.injected_error = true,
                Role::InjectedOffset => parts.injected_offset = true,
                _ => {}
            }
            rest = others;
        }
        parts
    }

    const fn all(there: bool) -> Self {
        Self {
            time_stamp: there,
            raw_position: there,
            diagnosis: there,
            movement: there,
            injected_error: there,
            injected_offset: there,
            gear: there,
        }
    }
}
