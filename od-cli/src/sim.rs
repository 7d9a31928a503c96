//! `odkit sim`: live nodes that masters reach over slcan, SocketCAN or socketcand.

use clap::{Arg, ArgAction, ArgMatches, Command};
use od_bench::serve::options::{CHOICES, Choice, Options};
use od_bench::serve::{self, Maker};

use crate::failure::Failure;
use crate::source::Source;

/// Run live nodes; masters connect over slcan, SocketCAN or socketcand
///
/// All devices and masters share one bus: a frame of one reaches all others over every link. Time is
/// real. Press Ctrl-C to stop.
///
/// Links: slcan:HOST:PORT (TCP), slcan:pty (a pseudo-terminal, whose path is printed),
/// slcan:/dev/ttyUSB0[@BAUD] (serial), socketcand:HOST:PORT, socketcan:vcan0 (Linux), and -
/// (standard input takes frames and script lines such as `power cycle 2s`; standard output is a
/// candump log).
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Built-in devices, or EDS or DCF files
    #[arg(value_name = "DEVICE|FILE", required_unless_present = "more")]
    devices: Vec<String>,
    /// Another device on the bus; may be repeated
    #[arg(long = "device", value_name = "DEVICE|FILE")]
    more: Vec<String>,
    #[command(flatten)]
    live: Live,
}

/// The options of the bench, as clap reads them.
struct Live(Options);

impl clap::Args for Live {
    fn augment_args(command: Command) -> Command {
        command.args(CHOICES.iter().map(argument))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

fn argument(choice: &'static Choice) -> Arg {
    let check = |text: &str| {
        let result = choice.set(&mut Options::default(), text);
        result.map(|()| text.to_owned())
    };
    let argument = Arg::new(choice.name).long(choice.name).help(choice.help);
    if choice.value.is_empty() {
        return argument.action(ArgAction::SetTrue);
    }
    let argument = argument
        .value_name(choice.value)
        .allow_negative_numbers(choice.name == "rpm")
        .default_value(choice.default)
        .conflicts_with_all(choice.conflicts)
        .value_parser(check);
    match choice.repeats {
        true => argument.action(ArgAction::Append),
        false => argument,
    }
}

impl clap::FromArgMatches for Live {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let mut live = Self(Options::default());
        live.update_from_arg_matches(matches)?;
        Ok(live)
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        for choice in &CHOICES {
            let texts: Vec<&str> = match choice.value {
                "" => Vec::from_iter(matches.get_flag(choice.name).then_some("")),
                _ => {
                    let texts = matches.get_many::<String>(choice.name);
                    texts.into_iter().flatten().map(String::as_str).collect()
                }
            };
            for text in texts {
                let result = choice.set(&mut self.0, text);
                result.map_err(|why| {
                    clap::Error::raw(clap::error::ErrorKind::ValueValidation, why)
                })?;
            }
        }
        Ok(())
    }
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let mut makers = Vec::new();
    for name in args.devices.iter().chain(&args.more) {
        let source = Source::find(name)?;
        makers.push(Maker {
            name,
            kind: source.kind,
            make: Box::new(move |node_id| source.device(node_id)),
        });
    }
    Ok(serve::run(&makers, &args.live.0)?)
}
