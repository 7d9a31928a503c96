//! Devices that the compiler knows, with the node of their firmware.

use std::prelude::v1::*;

use od_runtime::encoder::Encoder;
use od_runtime::{Application, Device, Extras, Node, Profile};

use crate::behaviour::Behaviour;
use crate::device::VirtualDevice;
use crate::shaft::Shaft;
use crate::source::Source;

impl VirtualDevice {
    /// A device of one's own with nothing but its dictionary: CiA 301 to the letter unless the node
    /// has a profile, and an encoder behind it where there is a position (6004h).
    ///
    /// `node` is the one that `object_dictionary!` made a type of, with the sizes of the firmware.
    /// A node that does not know its dictionary does not compile.
    pub fn of<
        D: Device + Send + 'static,
        const PDO: usize,
        const SDO: usize,
        X: Extras<D, SDO> + Send + 'static,
    >(
        title: &str,
        node: Node<D, PDO, SDO, X>,
    ) -> Self {
        let source = Source::of::<D>();
        let behaviour = Behaviour::of(source.dictionary());
        let profile = D::PROFILE.copied().unwrap_or(Profile::CIA301);
        Self::build(title.into(), source, behaviour, profile, Box::new(node))
    }

    /// As [`of`](Self::of), with behaviour of one's own, and what the services do differently.
    pub fn with_application<
        D: Device + Send + 'static,
        const PDO: usize,
        const SDO: usize,
        X: Extras<D, SDO> + Send + 'static,
    >(
        title: &str,
        node: Node<D, PDO, SDO, X>,
        profile: &'static Profile,
        application: Box<dyn Application + Send>,
    ) -> Self {
        let behaviour = Behaviour::Other(application);
        let source = Source::of::<D>();
        Self::build(title.into(), source, behaviour, *profile, Box::new(node))
    }

    /// As [`of`](Self::of), with this encoder, which the bench turns, and what the services do
    /// differently.
    pub fn with_encoder<
        D: Device + Send + 'static,
        const PDO: usize,
        const SDO: usize,
        X: Extras<D, SDO> + Send + 'static,
    >(
        title: &str,
        node: Node<D, PDO, SDO, X>,
        profile: &'static Profile,
        encoder: Encoder<Shaft>,
    ) -> Self {
        let behaviour = Behaviour::Encoder(Box::new(encoder));
        let source = Source::of::<D>();
        Self::build(title.into(), source, behaviour, *profile, Box::new(node))
    }
}
