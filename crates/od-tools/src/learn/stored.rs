//! The EDS that a node stores: 1021h, in the format of 1022h (CiA 301, 7.5.2.24 and 7.5.2.25).

use od_eds::Document;
use od_model::Address;
use od_wire::NodeId;

use crate::error::Error;
use crate::link::Link;
use crate::master::Master;

/// Content of 1021h.
#[derive(Clone, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum Stored {
    /// The text of an EDS.
    Eds(String),
    /// A text that odkit cannot read: the reason, a clause.
    Unreadable(String),
}

/// Reads the EDS that a node stores; `None` if it stores none.
///
/// # Errors
/// The link is lost, or the node stops responding.
pub fn stored(link: impl Link, node: NodeId) -> Result<Option<Stored>, Error> {
    let mut master = Master::new(link, node);
    let Ok(bytes) = Error::or_abort(master.upload(Address::new(0x1021, 0)))? else {
        return Ok(None);
    };
    if bytes.is_empty() {
        return Ok(None);
    }
    let format = Error::or_abort(master.upload(Address::new(0x1022, 0)))?;
    // A node without 1022h has the format 0: a text that is not compressed.
    let format = format.unwrap_or_default();
    if let Some(format) = format.first().filter(|format| **format != 0) {
        let why = format!("its format is {format} (1022h); odkit reads format 0, plain text");
        return Ok(Some(Stored::Unreadable(why)));
    }
    let text = Document::new(bytes).text().to_owned();
    Ok(Some(
        if od_eds::parse(&text).description.objects.is_empty() {
            Stored::Unreadable("it does not define any object".into())
        } else {
            Stored::Eds(text)
        },
    ))
}
