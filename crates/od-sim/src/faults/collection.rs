//! The text of the fault cases: their causes, benches and probes, and its translation.

use std::format;
use std::prelude::v1::*;

use super::probe::Probe;
use crate::grammar::problem::Problem;
use crate::lesson::Block;
use crate::script::Script;

/// Longest text, in bytes; a longer one is refused.
const LONGEST: usize = 256 * 1024;
/// Maximum number of causes, and of probes, of a case: a mark plays each probe for each cause.
const MOST: usize = 10;

/// All cases of a text, and the causes that they share.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Collection {
    /// The cases, in order.
    pub cases: Vec<Case>,
    /// The causes, in order.
    pub causes: Vec<Cause>,
}

/// A reason for a fault.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Cause {
    /// Short name, the same in every language.
    pub name: String,
    /// The cause in words.
    pub title: String,
    /// Proof of the cause, and its correction, as Markdown.
    pub proof: String,
    /// The lines that make it on the bench of a case.
    pub fault: Block,
}

/// A case: a machine with a symptom.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Case {
    /// Short name, the same in every language.
    pub name: String,
    /// The symptom in words.
    pub title: String,
    /// The machine and the symptom, as Markdown.
    pub story: String,
    /// Names of the built-in devices that the device `suspect` can be; empty: that of the bench.
    pub devices: Vec<String>,
    /// The blocks whose lines make the healthy bench: one that cases share, and its own.
    pub bench: Vec<Block>,
    /// The possible causes: their numbers in the collection.
    pub causes: Vec<usize>,
    /// The probe that shows the symptom: with each cause it reads differently than on the healthy bench.
    pub symptom: Option<Probe>,
    /// The probes of the learner.
    pub probes: Vec<Probe>,
}

/// A part of the text: the sections below one of its main headings.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Part {
    Benches,
    Causes,
    Cases,
}

/// A heading, its prose, and its blocks.
struct Section {
    line: u32,
    part: Part,
    name: String,
    title: String,
    prose: String,
    blocks: Vec<(String, Block)>,
}

impl Collection {
    /// Reads a text.
    ///
    /// # Errors
    /// All problems, in the order of their lines.
    pub fn parse(text: &str) -> Result<Self, Vec<Problem>> {
        let (sections, mut problems) = sections(text);
        let mut collection = Self::default();
        let benches: Vec<(&str, Block)> = (sections.iter())
            .filter(|section| section.part == Part::Benches)
            .map(|section| (&*section.name, section.block("bench", &mut problems)))
            .collect();
        for (_, bench) in &benches {
            check(bench, &mut problems);
        }
        for section in sections
            .iter()
            .filter(|section| section.part == Part::Causes)
        {
            let fault = section.block("fault", &mut problems);
            check(&fault, &mut problems);
            collection.causes.push(Cause {
                name: section.name.clone(),
                title: section.title.clone(),
                proof: section.prose.clone(),
                fault,
            });
        }
        for section in sections
            .iter()
            .filter(|section| section.part == Part::Cases)
        {
            let case = collection.case(section, &benches, &mut problems);
            collection.cases.push(case);
        }
        if problems.is_empty() {
            Ok(collection)
        } else {
            problems.sort_by_key(|problem| problem.line);
            Err(problems)
        }
    }

    fn case(
        &self,
        section: &Section,
        benches: &[(&str, Block)],
        problems: &mut Vec<Problem>,
    ) -> Case {
        let words = |block: &Block| -> Vec<(u32, String)> {
            let lines = (block.line..).zip(block.text.lines());
            let lines = lines.map(|(number, line)| (number, line.trim().to_owned()));
            lines.filter(|(_, line)| !line.is_empty()).collect()
        };
        let mut bench = Vec::new();
        let mut own = section.block("bench", problems);
        let shared = own
            .text
            .lines()
            .next()
            .and_then(|line| line.strip_prefix("bench "));
        if let Some(name) = shared {
            match benches.iter().find(|(known, _)| *known == name.trim()) {
                Some((_, block)) => bench.push(block.clone()),
                None => problems.push(Problem::new(
                    own.line,
                    format!("bench `{name}` does not exist"),
                    "write the name of a section below `# Benches`",
                )),
            }
            let rest = own.text.split_once('\n').map_or("", |(_, rest)| rest);
            let (line, text) = (own.line + 1, rest.to_owned());
            own = Block { line, text };
        }
        check(&own, problems);
        bench.push(own);
        let mut causes = Vec::new();
        for (line, name) in words(&section.block("causes", problems)) {
            match self.causes.iter().position(|cause| cause.name == name) {
                Some(number) => causes.push(number),
                None => problems.push(Problem::new(
                    line,
                    format!("cause `{name}` does not exist"),
                    "write the name of a section below `# Causes`",
                )),
            }
        }
        let mut probes = |block: &Block| -> Vec<Probe> {
            let mut probes = Vec::new();
            for (line, text) in words(block) {
                match Probe::parse(line, &text) {
                    Ok(probe) => probes.push(probe),
                    Err(problem) => problems.push(problem),
                }
            }
            probes
        };
        let shown = probes(&section.blocks_named("probes"));
        let symptom = probes(&section.blocks_named("symptom")).into_iter().next();
        let devices = words(&section.blocks_named("devices"));
        let case = Case {
            name: section.name.clone(),
            title: section.title.clone(),
            story: section.prose.clone(),
            devices: devices.into_iter().map(|(_, name)| name).collect(),
            bench,
            causes,
            symptom,
            probes: shown,
        };
        let lacks = [
            (case.symptom.is_none(), "no symptom"),
            (
                !(2..=MOST).contains(&case.causes.len()),
                "not 2 to 10 causes",
            ),
            (
                !(1..=MOST).contains(&case.probes.len()),
                "not 1 to 10 probes",
            ),
        ];
        for (_, what) in lacks.into_iter().filter(|(lacks, _)| *lacks) {
            let message = format!("the case `{}` has {what}", section.name);
            let help = "write blocks `symptom`, `causes` and `probes` with a line for each";
            problems.push(Problem::new(section.line, message, help));
        }
        case
    }

    /// Replaces titles and prose by those of a translation, which has the same headings without blocks.
    ///
    /// # Errors
    /// The sections of the translation that do not fit, and those that are missing.
    pub fn translate(mut self, translation: &str) -> Result<Self, Vec<Problem>> {
        let (sections, mut problems) = sections(translation);
        let mut parts: Vec<(Part, &str, &mut String, &mut String)> = Vec::new();
        for one in &mut self.causes {
            parts.push((Part::Causes, &one.name, &mut one.title, &mut one.proof));
        }
        for one in &mut self.cases {
            parts.push((Part::Cases, &one.name, &mut one.title, &mut one.story));
        }
        for (part, name, title, prose) in parts {
            let own = |section: &&Section| section.part == part && section.name == name;
            match sections.iter().find(own) {
                Some(section) => {
                    title.clone_from(&section.title);
                    prose.clone_from(&section.prose);
                }
                None => problems.push(Problem::new(
                    1,
                    format!("`{name}` is not translated"),
                    "add a section of this name",
                )),
            }
        }
        let known = |section: &&Section| {
            let mut cases = self.cases.iter().map(|one| &one.name);
            let mut causes = self.causes.iter().map(|one| &one.name);
            let is_known = match section.part {
                Part::Cases => cases.any(|name| *name == section.name),
                Part::Causes => causes.any(|name| *name == section.name),
                Part::Benches => false,
            };
            !is_known || !section.blocks.is_empty()
        };
        for section in sections.iter().filter(known) {
            let message = format!("`{}` does not exist, or has blocks", section.name);
            let help = "write titles and prose of the sections of the original";
            problems.push(Problem::new(section.line, message, help));
        }
        if problems.is_empty() {
            Ok(self)
        } else {
            Err(problems)
        }
    }
}

impl Section {
    /// A block that must exist.
    fn block(&self, name: &str, problems: &mut Vec<Problem>) -> Block {
        let block = self.blocks_named(name);
        if block.line == 0 {
            let message = format!("`{}` has no block `{name}`", self.name);
            let help = "add a block that begins with three backticks and its name";
            problems.push(Problem::new(self.line, message, help));
        }
        block
    }

    /// The block of this name; an empty one if it is missing.
    fn blocks_named(&self, name: &str) -> Block {
        let block = self.blocks.iter().find(|(known, _)| known == name);
        block.map(|(_, block)| block.clone()).unwrap_or_default()
    }
}

/// Reports lines that are not lines of a script.
fn check(block: &Block, problems: &mut Vec<Problem>) {
    if let Err(all) = Script::parse_at(&block.text, block.line) {
        problems.extend(all);
    }
}

/// The sections of a text below its main headings: `## name: title`, prose, blocks.
fn sections(text: &str) -> (Vec<Section>, Vec<Problem>) {
    let (mut sections, mut problems) = (Vec::<Section>::new(), Vec::new());
    if text.len() > LONGEST {
        let help = "split it into two texts";
        problems.push(Problem::new(1, "the text is longer than 256 KiB", help));
        return (sections, problems);
    }
    let mut part = None;
    let mut fence: Option<(String, Block)> = None;
    for (number, line) in (1..).zip(text.lines()) {
        if let Some((_, block)) = &mut fence {
            if line.trim() != "```" {
                block.text.push_str(line);
                block.text.push('\n');
            } else if let (Some(section), Some(block)) = (sections.last_mut(), fence.take()) {
                section.blocks.push(block);
            }
            continue;
        }
        if let Some(name) = line.strip_prefix("```") {
            let line = number + 1;
            let text = String::new();
            fence = Some((name.trim().to_owned(), Block { line, text }));
        } else if let Some(title) = line.strip_prefix("# ") {
            part = match title.trim() {
                "Benches" => Some(Part::Benches),
                "Causes" => Some(Part::Causes),
                "Cases" => Some(Part::Cases),
                _ => None,
            };
        } else if let Some(heading) = line.strip_prefix("## ") {
            match (part, heading.split_once(':')) {
                (Some(part), Some((name, title))) => sections.push(Section {
                    line: number,
                    part,
                    name: name.trim().to_owned(),
                    title: title.trim().to_owned(),
                    prose: String::new(),
                    blocks: Vec::new(),
                }),
                _ => problems.push(Problem::new(
                    number,
                    "the heading is not `## name: title` below `# Benches`, `# Causes` or `# Cases`",
                    "write the name that cases use, a colon, and the title",
                )),
            }
        } else if let Some(section) = sections.last_mut() {
            section.prose.push_str(line.trim_end());
            section.prose.push('\n');
        }
    }
    if let Some((_, block)) = fence {
        let help = "close it with three backticks";
        problems.push(Problem::new(
            block.line - 1,
            "this block is not closed",
            help,
        ));
    }
    for section in &mut sections {
        section.prose = section.prose.trim().to_owned();
    }
    (sections, problems)
}
