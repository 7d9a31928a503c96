//! A link that works: who speaks what over it.

use std::net::SocketAddr;

use mio::net::TcpListener;

use super::port::Port;
use crate::links::Codec;
use crate::links::can_frame::CanSocket;
use crate::links::lines::Lines;
use crate::links::slcan::Channel;
use crate::links::socketcand::Session;

/// Protocol of a client.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(in crate::serve) enum Protocol {
    Slcan,
    Socketcand,
    /// `struct can_frame` of Linux.
    CanFrame,
    /// Lines of the script language in, a candump log out.
    Lines,
}

impl Protocol {
    /// Makes the codec of one client.
    pub(in crate::serve) fn codec(self) -> Box<dyn Codec> {
        match self {
            Self::Slcan => Box::<Channel>::default(),
            Self::Socketcand => Box::<Session>::default(),
            Self::CanFrame => Box::new(CanSocket),
            Self::Lines => Box::<Lines>::default(),
        }
    }
}

/// A link that works.
pub(in crate::serve) enum Opened {
    /// Clients come and go.
    Listener(Protocol, TcpListener, SocketAddr),
    /// There is one client, and it is there already.
    Ends(Ends),
}

/// The client of a link that has one.
pub(in crate::serve) struct Ends {
    /// Name in messages; for a pseudo-terminal the path that others open.
    pub(in crate::serve) name: String,
    pub(in crate::serve) protocol: Protocol,
    pub(in crate::serve) port: Box<dyn Port>,
}
