//! The conformance test: cases that a node passes, fails or skips.
//!
//! ```
//! use od_sim::VirtualDevice;
//! use od_sim::bus::Bus;
//! use od_tools::bench::OnBench;
//! use od_tools::conform::case::built_in;
//! use od_tools::conform::eds::Eds;
//! use od_tools::conform::session::{Permissions, Session};
//! use od_wire::NodeId;
//!
//! let text = include_str!("../../../../devices/eds/GXMM.eds");
//! let mut bus = Bus::new();
//! let device = VirtualDevice::from_eds(text, Default::default()).expect("an EDS");
//! let number = bus.add(device);
//! bus.start(number);
//! let eds = Eds::read(text);
//! let mut rig = OnBench(bus);
//! let mut session = Session::new(&mut rig, &eds, NodeId::ONE, Permissions::default());
//! let case = built_in().iter().find(|case| case.id == "sdo-upload-expedited");
//! let record = session.run(case.expect("a case"));
//! assert!(record.verdict.is_pass());
//! assert!(!record.frames.is_empty());
//! ```
//!
//! | file | contents |
//! |---|---|
//! | `case` | a case: head and steps |
//! | `eds` | facts about the node in the EDS: which cases apply |
//! | `rig` | a link that may also switch the power |
//! | `pulse` | how late this computer is, as evidence for the node |
//! | `dut`, `sdo` | the node under test, and strict transfers with it |
//! | `check/` | the table of the built-in cases, and their checks in Rust, a file for each service |
//! | `cases/` | the built-in cases that are scripts |
//! | `play`, `aside` | the steps that are lines of a script: on any link, or on a separate bench |
//! | `official` | the cases of the official test that ours cover |
//! | `session` | runs the cases, and restores what each changed |
//! | `report/` | the records as text, JSON, JUnit, Markdown, HTML |

pub mod aside;
pub mod case;
mod check;
mod deviations;
pub mod dut;
pub mod eds;
mod end;
pub mod official;
mod play;
pub mod pulse;
pub mod record;
pub mod report;
pub mod rig;
mod sdo;
pub mod session;
