//! The options of a live bench, for clap.

use clap::{Arg, ArgAction, ArgMatches, Command};
use od_sim::serve::options::{CHOICES, Choice, Options};

/// Options about links.
const WIRE: [&str; 6] = [
    "link",
    "origin",
    "max-clients",
    "log",
    "ready-file",
    "quiet",
];

/// The options of the bench, for clap; without `DEVICES` only those about links.
pub(crate) struct Live<const DEVICES: bool>(pub(crate) Options);

fn choices(devices: bool) -> impl Iterator<Item = &'static Choice> {
    let all = CHOICES.iter();
    all.filter(move |choice| devices || WIRE.contains(&choice.name))
}

impl<const DEVICES: bool> clap::Args for Live<DEVICES> {
    fn augment_args(command: Command) -> Command {
        command.args(choices(DEVICES).map(argument))
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
    if choice.repeats {
        argument.action(ArgAction::Append)
    } else {
        argument
    }
}

impl<const DEVICES: bool> clap::FromArgMatches for Live<DEVICES> {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let mut live = Self(Options::default());
        live.update_from_arg_matches(matches)?;
        Ok(live)
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        for choice in choices(DEVICES) {
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
