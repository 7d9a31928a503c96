//! The command line from outside: a module for each subcommand. One program, since each takes time to link.

#[path = "../support/mod.rs"]
mod support;

#[cfg(unix)]
mod background;
mod bridge;
#[cfg(unix)]
mod bus;
mod campaign;
mod canopennode;
mod check;
mod class;
mod conform;
#[cfg(unix)]
mod control;
mod convert;
mod dbc;
mod diagnose;
mod diff;
mod eeprom;
mod export;
mod files;
mod foreign;
mod guests;
mod lesson;
#[cfg(target_os = "linux")]
mod limits;
mod links;
mod network;
mod new;
mod new_firmware;
mod outputs;
mod overlay;
mod project;
mod run;
mod sim;
mod tools;
