//! EAM and EN580C as manuals 001 and 003 have their encoders, in SDO frames; and the positions
//! of every family against a second calculation.

mod bench;
mod diagnosis;
mod gear;
mod movement;
mod position;
mod power;
mod reference;
mod reference_bus_cover;
mod sampled;
