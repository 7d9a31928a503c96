//! `nodelist.cpj`: the networks of a project and the DCF of each node (CiA 306-3).

use alloc::collections::BTreeMap;
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use super::keys::{OF_LIST, OF_LISTED, names};
use super::node::Node;
use super::saved::saved;
use crate::description::Description;
use crate::finding::Finding;
use crate::log::Log;
use crate::rules::network::list::{
    w1207_bit_rate_differs, w1207_duplicate_section, w1207_key_misspelled, w1207_key_twice,
    w1207_node_count, w1207_node_id_differs, w1207_node_id_not_valid, w1207_present_not_valid,
    w1207_same_name, w1207_section_misspelled,
};
use crate::rules::network::project::unfit;
use crate::rules::network::reading::{e1216_no_file, missing_section, unreadable, unusable_file};
use crate::scan::forms::{near, nearest};
use crate::scan::lines::{Fault, scan};
use crate::scan::number::number;
use crate::scan::section::{Text, TextSection};
use crate::span::Span;

/// One network of a node list.
pub struct NodeList {
    /// NetName; empty if it has none.
    pub name: String,
    /// Bit rate in kbit/s of the first node whose DCF has one.
    pub bit_rate: Option<u32>,
    /// The nodes that are present, by ascending node ID, with the writes of their DCFs.
    pub nodes: Vec<Node>,
    /// Contradictions within the list and with the DCFs, and nodes that cannot be read.
    pub findings: Vec<Finding>,
    /// Whether all nodes that are present could be read.
    pub is_complete: bool,
}

/// The keys of one node, with their values.
#[derive(Default)]
struct Listed<'a> {
    present: Option<Pair<'a>>,
    name: Option<Pair<'a>>,
    file: Option<Pair<'a>>,
}

/// A key and its value.
type Pair<'a> = (&'a Text<'a>, &'a Text<'a>);

/// Reads the networks of a node list; `load` reads the description at a path.
pub fn node_lists(text: &str, load: &dyn Fn(&str) -> Result<Description, String>) -> Vec<NodeList> {
    let mut many = None;
    let sections = scan(text, &mut |fault| {
        if let Fault::Many { at, most, of } = fault {
            let why = format!("a node list has at most {most} {of}");
            many = Some(NodeList::of_error(unreadable(&why, *at)));
        }
    });
    if let Some(many) = many {
        return Vec::from([many]);
    }
    let is_network = |section: &&TextSection<'_>| {
        let start = section.name.get(.."Topology".len());
        let is_one = start.is_some_and(|start| start.eq_ignore_ascii_case("Topology"));
        is_one || meant_section(&section.name).is_some()
    };
    let networks = sections.iter().filter(is_network);
    let mut known: Vec<String> = Vec::new();
    let mut networks: Vec<_> = networks
        .map(|section| {
            let mut list = topology(section, load);
            let name = section.name.to_ascii_lowercase();
            if known.contains(&name) {
                let finding = w1207_duplicate_section(section.header, &section.name);
                list.findings.insert(0, finding);
            }
            known.push(name);
            if let Some(right) = meant_section(&section.name) {
                let finding = w1207_section_misspelled(&section.name, &right);
                list.findings.insert(0, finding);
            }
            list
        })
        .collect();
    if networks.is_empty() {
        networks.push(NodeList::of_error(missing_section("[Topology]")));
    }
    networks
}

impl NodeList {
    /// A list without nodes, because of this error.
    fn of_error(error: Finding) -> Self {
        Self {
            name: String::new(),
            bit_rate: None,
            nodes: Vec::new(),
            findings: Vec::from([error]),
            is_complete: false,
        }
    }
}

/// The name of the section that this misspells: `Topology2` for `Topologyy2`. Several networks have names with something
/// behind it.
fn meant_section(section: &str) -> Option<String> {
    let word = section.trim_end_matches(|c: char| !c.is_alphabetic());
    let most = if word.len() > "Topology".len() { 1 } else { 2 };
    let right = nearest(word, ["Topology"].into_iter(), most)?;
    Some(format!("{right}{}", &section[word.len()..]))
}

/// The keys of each node of a network, by ascending node ID.
fn listed<'a>(section: &'a TextSection<'_>, log: &mut Log) -> BTreeMap<u8, Listed<'a>> {
    let mut nodes: BTreeMap<u8, Listed<'_>> = BTreeMap::new();
    // The number is decimal; some tools write hexadecimal digits. The first of equal keys is used.
    for is_hex in [false, true] {
        for (key, value) in section.pairs.iter().filter(|(_, value)| !value.is_empty()) {
            let Some((id, what)) = node_key(key).filter(|_| is_hexadecimal(key) == is_hex) else {
                if !is_hex
                    && !is_hexadecimal(key)
                    && let Some(right) = meant(key)
                {
                    let is_free = section.get(&right).is_none();
                    let is_needed = is_free && right.ends_with("DCFName");
                    log.push(w1207_key_misspelled(key, &right, is_needed, is_free));
                }
                continue;
            };
            let Some(id) = u8::try_from(id).ok().filter(|id| (1..=127).contains(id)) else {
                if !matches!(what, What::Name) && number(value) != Some(0) {
                    log.push(w1207_node_id_not_valid(key));
                }
                continue;
            };
            let node = nodes.entry(id).or_default();
            let place = match what {
                What::Present => &mut node.present,
                What::Name => &mut node.name,
                What::File => &mut node.file,
            };
            match place {
                Some(first) => log.push(w1207_key_twice(key, value, first)),
                None => *place = Some((key, value)),
            }
        }
    }
    nodes
}

fn topology(
    section: &TextSection<'_>,
    load: &dyn Fn(&str) -> Result<Description, String>,
) -> NodeList {
    let mut log = Log::default();
    let nodes = listed(section, &mut log);
    let all: Vec<u8> = nodes.keys().copied().collect();
    let mut list = NodeList {
        name: section
            .get("NetName")
            .map(|name| name.to_string())
            .unwrap_or_default(),
        bit_rate: None,
        nodes: Vec::new(),
        findings: Vec::new(),
        is_complete: true,
    };
    let mut names: BTreeMap<&str, u8> = BTreeMap::new();
    for (id, listed) in nodes {
        let present = value_of(listed.present).map(|present| (present, number(present)));
        if let Some((given, number)) = present
            && !matches!(number, Some(0 | 1))
        {
            log.push(w1207_present_not_valid(given, id));
        }
        let is_present = present.and_then(|(_, number)| number);
        let Some(file) = value_of(listed.file).filter(|_| is_present != Some(0)) else {
            if let Some((present, Some(1..))) = present {
                let right = format!("Node{id}DCFName");
                let mut keys = section.pairs.iter().map(|(key, _)| key);
                let empty = keys.clone().find(|key| key.eq_ignore_ascii_case(&right));
                // A misspelled key is reported already.
                if !keys.any(|key| meant(key).as_ref() == Some(&right)) {
                    let place = empty.map_or(present.span, |key| key.span);
                    log.push(e1216_no_file(id, place));
                }
                list.is_complete = false;
            }
            continue;
        };
        let path = file.replace('\\', "/");
        let node = format!("node {id}");
        let description = match load(&path) {
            Ok(description) => description,
            Err(why) => {
                log.push(unusable_file(&node, &path, &why, file.span));
                list.is_complete = false;
                continue;
            }
        };
        if let Some(own) = description.commissioned_node_id().filter(|own| *own != id) {
            let keys = if all.contains(&own) {
                Vec::new()
            } else {
                renumbered(section, id, own)
            };
            log.push(w1207_node_id_differs(file, id, own, &keys));
        }
        let rate = description.commissioning().and_then(|own| own.bit_rate);
        if let Some(rate) = rate.map(u32::from) {
            let first = *list.bit_rate.get_or_insert(rate);
            if first != rate {
                log.push(w1207_bit_rate_differs(file, rate, first));
            }
        }
        if let Some(name) = value_of(listed.name) {
            match names.get(name.as_ref()) {
                Some(other) => log.push(w1207_same_name(name, id, *other)),
                None => drop(names.insert(name.as_ref(), id)),
            }
        }
        let name =
            value_of(listed.name).map_or_else(|| format!("node{id}"), |name| name.to_string());
        let mut node = Node::new(name, id, description);
        match saved(&node) {
            Ok(writes) => node.writes = writes,
            Err(wrong) => {
                log.push(unfit(&node, &wrong, file.span, None));
                list.is_complete = false;
                continue;
            }
        }
        if !node.writes.is_empty() {
            node.configuration_file = format!("{}.bin", node.name);
        }
        node.place = file.span;
        list.nodes.push(node);
    }
    let count = section.get("Nodes").filter(|count| !count.is_empty());
    // Some tools count the nodes that are not present, too.
    let counts = [list.nodes.len(), all.len()].map(|count| Some(count as i128));
    list.findings = log.finish();
    if let Some(given) = count
        && (list.is_complete || number(given).is_none())
        && !counts.contains(&number(given))
    {
        let finding = w1207_node_count(given, list.nodes.len(), list.findings.is_empty());
        list.findings.push(finding);
    }
    list
}

fn value_of<'a>(pair: Option<Pair<'a>>) -> Option<&'a Text<'a>> {
    pair.map(|(_, value)| value)
}

/// The keys of a node, each with the key of a node with another node ID.
fn renumbered(section: &TextSection<'_>, id: u8, own: u8) -> Vec<(Span, String)> {
    let start = format!("node{id}");
    let keys = section.pairs.iter().map(|(key, _)| key);
    let own_key = |key: &Text<'_>| {
        let rest = key.get(start.len()..)?;
        let is_of_node = key.to_ascii_lowercase().starts_with(&start)
            && rest.starts_with(|c: char| c.is_ascii_alphabetic());
        is_of_node.then(|| (key.span, format!("{}{own}{rest}", &key[.."Node".len()])))
    };
    keys.filter_map(own_key).collect()
}

/// The key of CiA 306-3 that a key misspells: `Node5DCFName` for `Node5DCFNam`.
fn meant(key: &str) -> Option<String> {
    let at = key.find(|c: char| c.is_ascii_digit());
    let Some((start, rest)) = at.and_then(|at| key.split_at_checked(at)) else {
        return near(key, names(OF_LIST)).map(String::from);
    };
    let end = rest.trim_start_matches(|c: char| c.is_ascii_digit());
    let number = rest.strip_suffix(end)?;
    let is_node = start.eq_ignore_ascii_case("Node");
    let is_known = names(OF_LISTED).any(|own| own.eq_ignore_ascii_case(end));
    let end = match is_known {
        true if is_node => return None,
        true => end,
        false => near(end, names(OF_LISTED))?,
    };
    if !is_node {
        near(start, ["Node"].into_iter())?;
    }
    Some(format!("Node{number}{end}"))
}

/// The part of a node's key after its number.
#[derive(Clone, Copy)]
enum What {
    Present,
    Name,
    File,
}

fn is_hexadecimal(key: &str) -> bool {
    let sign = key.get("Node".len().."Node0x".len());
    sign.is_some_and(|sign| sign.eq_ignore_ascii_case("0x"))
}

/// The number and the rest of `Node5DCFName`; `None` for other keys.
fn node_key(key: &str) -> Option<(u32, What)> {
    let key = key.to_ascii_lowercase();
    let rest = key.strip_prefix("node")?;
    // Longest first: DCFName ends with Name.
    let ends = [
        ("present", What::Present),
        ("dcfname", What::File),
        ("name", What::Name),
    ];
    let (digits, what) = ends
        .into_iter()
        .find_map(|(end, what)| Some((rest.strip_suffix(end)?, what)))?;
    let id = match digits.strip_prefix("0x") {
        Some(hex) => u32::from_str_radix(hex, 16),
        None => digits.parse(),
    };
    // A number with more digits is not valid, either.
    let is_number = digits
        .bytes()
        .all(|byte| byte.is_ascii_hexdigit() || byte == b'x');
    is_number
        .then_some((id.unwrap_or(u32::MAX), what))
        .filter(|_| !digits.is_empty())
}
