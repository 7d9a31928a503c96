//! EAM and EN580C as in manuals 001 and 003, in SDO frames; and the positions
//! of every family compared with a second calculation.

mod bench;
mod diagnosis;
mod gear;
mod movement;
mod position;
mod power;
mod reference;
mod reference_bus_cover;
mod sampled;
