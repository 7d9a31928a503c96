//! A device of an EDS or DCF text.

use std::prelude::v1::*;
use std::sync::Arc;

use od_eds::{Description, Finding, Tables};
use od_runtime::{LssProfile, NodeId, Profile};

use crate::device::VirtualDevice;
use crate::device::application::DeviceApplication;
use crate::device::file_parts::FileParts;
use crate::device::left_out;
use crate::device::services::Services;
use crate::device::source::{Loaded, Source};

/// Choices that an EDS file leaves open.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct EdsOptions {
    /// The node ID; `None`: the one of the DCF, else 1.
    pub node_id: Option<NodeId>,
    /// Also runs a text with errors, as far as it can.
    pub lenient: bool,
}

impl VirtualDevice {
    /// A device of an EDS or DCF text: CiA 301 without deviations, and an encoder if there is a position value (6004h).
    ///
    /// # Errors
    /// The diagnostics, if one of them is an error and `options` is not lenient.
    pub fn from_eds(text: &str, options: EdsOptions) -> Result<Self, Vec<Finding>> {
        let (device, findings) = Self::read_eds(text, options);
        device.ok_or(findings)
    }

    /// As [`from_eds`](Self::from_eds); also returns the findings of a text that runs.
    pub fn read_eds(text: &str, options: EdsOptions) -> (Option<Self>, Vec<Finding>) {
        let mut parsed = od_eds::load(text);
        if !options.lenient && parsed.findings.iter().any(Finding::is_unsound) {
            return (None, parsed.findings);
        }
        left_out::fill(&mut parsed.description);
        let description = &parsed.description;
        let commissioned = description.commissioned_node_id().and_then(NodeId::new);
        let node_id = options.node_id.or(commissioned).unwrap_or(NodeId::ONE);
        let product = description
            .section("DeviceInfo")
            .and_then(|info| info.get("ProductName"));
        let title = product.map(|name| od_model::Visible(name.value.trim()).line().into_owned());
        let tables = Tables::new(description);
        let mut application = DeviceApplication::of(tables.dictionary());
        application.file_parts = Some(FileParts::of(tables.dictionary()));
        let title = title
            .filter(|title| !title.is_empty())
            .unwrap_or_else(|| "EDS device".into());
        let loaded = Loaded {
            source: Source::Loaded(Arc::new(tables)),
            profile: Profile {
                lss: lss(description),
                ..Profile::CIA301
            },
        };
        let mut device = Self::build(title, loaded, node_id, application);
        let has_lss = device.profile().lss.is_some();
        device.services = Services::of(device.dictionary(), has_lss, |key| {
            description.info_is_set(key)
        });
        let commissioning = description.commissioning().unwrap_or_default();
        if let Some(number) = commissioning.serial_number {
            device = device.with_serial_number(number);
        }
        (Some(device), parsed.findings)
    }
}

/// The LSS slave that an EDS declares, with the bit rates of its [DeviceInfo] (MANUALS.md U-43).
fn lss(description: &Description) -> Option<LssProfile> {
    let named = description.lss_bit_rates()?;
    let mut lss = LssProfile::CIA305;
    for (rate, named) in lss.bit_rates.iter_mut().zip(named) {
        *rate = rate.filter(|_| named);
    }
    Some(lss)
}
