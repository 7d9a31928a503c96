//! Many runs of one script, each with the draws of its seed.

use std::convert::Infallible;
use std::prelude::v1::*;

use super::host::Host;
use super::outcome::{Stop, Summary};
use super::read::Script;
use super::run::{Progress, play, run};
use crate::bench::Bench;
use crate::grammar::action::Action;

/// A script with `random` lines, ready to run with any seed.
///
/// ```
/// use od_sim::script::{Bare, Campaign, Script};
///
/// let script = Script::parse("device gxmm\nrandom shaft rpm 1..100\nexpect rpm < 50").unwrap();
/// let mut host = Bare(od_devices::DEVICES);
/// let campaign = Campaign::new(&script, &mut host).unwrap();
/// let failures = (0..20).filter_map(|seed| campaign.run(seed, &mut host).err());
/// for failure in failures {
///     assert!(failure.script().starts_with("device gxmm\nshaft rpm "));
/// }
/// ```
#[derive(Clone)]
pub struct Campaign<'s> {
    script: &'s Script,
    /// Number of lines before the first draw: they are the same for each seed.
    common: usize,
    /// Bench and progress after these lines.
    bench: Bench,
    progress: Progress,
}

/// A run that did not reach its end.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Failure {
    /// The line, its draw, and the reason.
    pub stop: Stop,
    /// The lines up to the one that failed, and whether each was drawn.
    lines: Vec<(String, bool)>,
}

impl Failure {
    /// A script without draws that does the same.
    pub fn script(&self) -> String {
        self.with(|_| true)
    }

    /// The script without the drawn lines that the failure does not need. All other lines stay.
    pub fn shrunk(&self, host: &mut dyn Host) -> String {
        let drawn = self.lines.iter().enumerate();
        let drawn: Vec<usize> = drawn
            .filter_map(|(at, (_, is_drawn))| is_drawn.then_some(at))
            .collect();
        let fails = |kept: &[usize]| {
            let script = Script::parse(&self.with(|at| kept.contains(&at)));
            let stop = script.ok().and_then(|script| run(&script, host).err());
            let is_same = |stop: &Stop| {
                let kinds = [&stop.reason, &self.stop.reason].map(std::mem::discriminant);
                stop.text == self.stop.text && kinds[0] == kinds[1]
            };
            Ok::<_, Infallible>(stop.is_some_and(|stop| is_same(&stop)))
        };
        let Ok(kept) = shrink(&drawn, fails);
        kept.map_or_else(|| self.script(), |kept| self.with(|at| kept.contains(&at)))
    }

    /// The script with only some of the drawn lines.
    fn with(&self, keeps: impl Fn(usize) -> bool) -> String {
        let lines = self.lines.iter().enumerate();
        let kept = lines.filter(|(at, (_, is_drawn))| !is_drawn || keeps(*at));
        kept.flat_map(|(_, (text, _))| [text.as_str(), "\n"])
            .collect()
    }
}

impl<'s> Campaign<'s> {
    /// Runs the lines before the first `random` line.
    ///
    /// # Errors
    /// One of these lines fails.
    pub fn new(script: &'s Script, host: &mut dyn Host) -> Result<Self, Box<Stop>> {
        let common = script.statements.iter();
        let common = common
            .take_while(|statement| !matches!(statement.action, Action::Random(_)))
            .count();
        let (mut bench, mut progress) = (Bench::default(), Progress::new(0));
        play(
            &script.statements[..common],
            &mut bench,
            host,
            &mut progress,
        )?;
        Ok(Self {
            script,
            common,
            bench,
            progress,
        })
    }

    /// Returns whether the script draws anything.
    pub fn draws(&self) -> bool {
        self.common < self.script.statements.len()
    }

    /// Runs the script with the draws of a seed, from its first draw on.
    ///
    /// # Errors
    /// The line that fails, and a script that fails in the same way.
    pub fn run(&self, seed: u64, host: &mut dyn Host) -> Result<Summary, Box<Failure>> {
        let (mut bench, mut progress) = (self.bench.clone(), self.progress.with_seed(seed));
        let rest = &self.script.statements[self.common..];
        match play(rest, &mut bench, host, &mut progress) {
            Ok(()) => Ok(progress.summary(bench.bus.now())),
            Err(stop) => Err(Box::new(Failure {
                lines: self.lines(stop.line, &progress.drawn),
                stop: *stop,
            })),
        }
    }

    /// The lines up to a number, with the drawn lines in place of `random` lines.
    fn lines(&self, last: u32, drawn: &[(u32, String)]) -> Vec<(String, bool)> {
        let mut lines = Vec::new();
        let statements = self.script.statements.iter();
        for statement in statements.take_while(|statement| statement.line <= last) {
            if matches!(statement.action, Action::Random(_)) {
                let own = drawn.iter().filter(|(line, _)| *line == statement.line);
                lines.extend(own.map(|(_, text)| (text.clone(), true)));
            } else {
                lines.push((statement.text.clone(), false));
            }
        }
        lines
    }
}

/// Drops items while the rest still fails: first half of them, in the end single ones, until no item can be dropped.
/// `None`: all of them do not fail.
///
/// # Errors
/// Those of `fails`.
pub fn shrink<T: Clone, E>(
    items: &[T],
    mut fails: impl FnMut(&[T]) -> Result<bool, E>,
) -> Result<Option<Vec<T>>, E> {
    if !fails(items)? {
        return Ok(None);
    }
    let mut items = items.to_vec();
    let mut size = items.len().div_ceil(2);
    while size > 0 {
        let (mut at, before) = (0, items.len());
        while at < items.len() {
            let end = items.len().min(at + size);
            let fewer = [&items[..at], &items[end..]].concat();
            if fails(&fewer)? {
                items = fewer;
            } else {
                at += size;
            }
        }
        // An item may be needed only by a later one, which is gone now.
        if size > 1 || items.len() == before {
            size /= 2;
        }
    }
    Ok(Some(items))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::script::{Bare, Reason};
    use std::string::ToString;

    const TEXT: &str = "device gxmm node 5   # the same for all seeds\nexpect 705#00\nignore 085#*\n\
                        random 3 times shaft rpm -3000..3000 | fault | wait 0..20ms\n\
                        power cycle 100ms\nexpect boot-up\nexpect rpm in -2900..2900\n";

    fn host() -> Bare {
        Bare(od_devices::DEVICES)
    }

    #[test]
    fn a_seed_gives_one_run_and_its_script_fails_alike() {
        let script = Script::parse(TEXT).expect("a script");
        let campaign = Campaign::new(&script, &mut host()).expect("a device boots");
        assert!(campaign.draws());
        let mut failures = 0;
        for seed in 0..500 {
            let one = campaign.run(seed, &mut host());
            assert_eq!(one, campaign.run(seed, &mut host()), "seed {seed}");
            let Err(failure) = one else { continue };
            failures += 1;
            let text = failure.script();
            let replay = Script::parse(&text).expect("a script without draws");
            assert!(!text.contains("random"), "{text}");
            let stop = run(&replay, &mut host()).expect_err("it fails, too");
            let (own, others) = (&failure.stop, &stop);
            assert_eq!((own.at, &own.reason), (others.at, &others.reason));
            assert_eq!(stop.text, "expect rpm in -2900..2900");
            let shrunk = failure.shrunk(&mut host());
            let lines: Vec<&str> = shrunk.lines().collect();
            assert_eq!(lines.len(), 7, "{shrunk}");
            assert!(lines[3].starts_with("shaft rpm "), "{shrunk}");
        }
        assert!((5..200).contains(&failures), "{failures} failures");
    }

    #[test]
    fn a_run_draws_by_the_seed_of_its_host() {
        let script = Script::parse("random shaft rpm 1..1000000\nexpect rpm = 0").expect("lines");
        let campaign = Campaign::new(&script, &mut host()).expect("no line before the draw");
        let failure = campaign.run(0, &mut host()).expect_err("it turns");
        let stop = run(&script, &mut host()).expect_err("it turns");
        assert_eq!(stop.reason, failure.stop.reason);
    }

    #[test]
    fn a_draw_that_is_not_possible_is_shown_as_drawn() {
        let script = Script::parse("device io\nrandom fault").expect("two lines");
        let campaign = Campaign::new(&script, &mut host()).expect("a device");
        let failure = campaign.run(7, &mut host()).expect_err("it has no faults");
        assert_eq!(
            failure.stop.to_string(),
            "line 2 at 0.000000 s: random fault\n  this device does not support any fault of scripts"
        );
        let script = Script::parse("device io\nrandom shaft rpm 5..5").expect("two lines");
        let campaign = Campaign::new(&script, &mut host()).expect("a device");
        let failure = campaign.run(7, &mut host()).expect_err("it has no shaft");
        assert_eq!(failure.stop.text, "shaft rpm 5");
        assert!(matches!(failure.stop.reason, Reason::Impossible(_)));
        assert_eq!(failure.script(), "device io\nshaft rpm 5\n");
        assert_eq!(failure.shrunk(&mut host()), failure.script());
    }

    #[test]
    fn shrinking_leaves_what_matters() {
        let all: Vec<u32> = (0..100).collect();
        let mut runs = 0;
        let shrunk = shrink(&all, |some| {
            runs += 1;
            let has = |item| some.contains(&item);
            // 20 is needed until 70 is gone.
            Ok::<_, Infallible>(has(13) && has(99) && (has(20) || !has(70)))
        });
        assert_eq!(shrunk, Ok(Some(Vec::from([13, 99]))));
        assert!(runs < 300, "{runs} runs");
        assert_eq!(shrink(&all, |_| Ok::<_, Infallible>(false)), Ok(None));
        assert_eq!(shrink(&all, |_| Err("no")), Err("no"));
        assert_eq!(
            shrink(&[1], |_| Ok::<_, Infallible>(true)),
            Ok(Some(Vec::new()))
        );
        assert_eq!(
            shrink(&[0; 0], |_| Ok::<_, Infallible>(true)),
            Ok(Some(Vec::new()))
        );
    }
}
