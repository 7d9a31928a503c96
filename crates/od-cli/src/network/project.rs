//! A project of dcfgen (dcf-tools) in YAML, also in the form of ros2_canopen, whose nodes are below `nodes` and
//! share `defaults`.

use std::collections::BTreeSet;

use od_eds::network::keys::{Keys, OF_MASTER, OF_OPTIONS, OF_PDO, OF_SLAVE};
use od_eds::network::{
    Configuration, Master, Node, NodeList, PdoConfiguration, ProjectSettings, Setting, Unfit,
    configure, consume_heartbeat, key_twice, missing_key, missing_section, misspelled_key, no_pdo,
    no_sync, not_a_number, not_mappable, read_only, text_of_flag, unfit, unfit_values, unreadable,
    unusable_file, unusual_bit_rate,
};
use od_eds::{Finding, Span};
use od_model::Address;

use super::yaml::Yaml;

/// A network that was read from a project or a node list.
#[derive(Default)]
pub(super) struct Network {
    /// Name; empty if it has none.
    pub(super) name: String,
    /// The master of a project; in a node list the master is a node.
    pub(super) master: Option<Master>,
    /// The places of the master and its settings.
    pub(super) master_places: (Span, Vec<(Setting, Span)>),
    /// Bit rate in kbit/s, if the file of a node has one.
    pub(super) bit_rate: Option<u32>,
    pub(super) nodes: Vec<Node>,
    /// Findings about the text.
    pub(super) findings: Vec<Finding>,
    /// Whether the master and all nodes could be read.
    pub(super) is_complete: bool,
}

impl Network {
    /// A network that cannot be read, because of this error.
    fn of_error(error: Finding) -> Self {
        Self {
            findings: vec![error],
            ..Self::default()
        }
    }
}

impl From<NodeList> for Network {
    fn from(list: NodeList) -> Self {
        Self {
            name: list.name,
            master: None,
            master_places: Default::default(),
            bit_rate: list.bit_rate,
            nodes: list.nodes,
            findings: list.findings,
            is_complete: list.is_complete,
        }
    }
}

/// The finding about what ends the reading of a node or the master.
type Problem = Box<Finding>;

/// Node IDs of a network. A text with more problems is not a project.
const MAX_NODES: usize = 127;

/// The keys of a slave and of a master that are flags.
const FLAGS: &[&str] = &[
    "heartbeat_consumer",
    "boot",
    "mandatory",
    "reset_communication",
    "start",
    "start_nodes",
    "start_all_nodes",
    "reset_all_nodes",
    "stop_all_nodes",
];

/// A section of a project: its name and its keys.
#[derive(Clone, Copy)]
struct Section<'a> {
    name: &'a str,
    /// Place of the name.
    place: Span,
    yaml: &'a Yaml,
    /// The whole project.
    whole: &'a Yaml,
}

impl<'a> Section<'a> {
    /// A part of the section, with keys of its own.
    const fn part(self, yaml: &'a Yaml) -> Self {
        Self {
            place: yaml.span,
            yaml,
            ..self
        }
    }

    /// The problem of a value that is not a number of this type.
    fn wrong<T: TryFrom<i128>>(&self, key: &str, value: &Yaml) -> Problem {
        let types = [u8::MAX.into(), u16::MAX.into(), u32::MAX];
        let mut fitting = types.into_iter().rev();
        let most = fitting.find(|most| T::try_from((*most).into()).is_ok());
        let has_limit = T::try_from(i128::MAX).is_err();
        self.wrong_number(key, value, most.filter(|_| has_limit))
    }

    fn wrong_number(&self, key: &str, value: &Yaml, most: Option<u32>) -> Problem {
        let is_number = value.integer().is_some();
        let finding = not_a_number(self.name, key, &value.text(), is_number, most, value.span);
        Box::new(finding)
    }

    /// A PDO below `rpdo` or `tpdo`: its number and its value.
    fn pdo_of(&self, key: &str, number: u16) -> Option<&'a (Yaml, Yaml)> {
        let mut entries = self.yaml.get(key)?.entries().iter();
        entries.find(|(own, _)| own.integer() == Some(number.into()))
    }

    /// The object at this position in the mapping of a PDO.
    fn mapped(&self, key: &str, number: u16, at: usize) -> Option<&'a Yaml> {
        self.pdo_of(key, number)?.1.get("mapping")?.list().get(at)
    }

    /// The problem of a value that the device of the node cannot have.
    fn unfit(&self, wrong: &Unfit, node: &Node, wanted: &Configuration) -> Problem {
        let place = self.place_of_write(wrong.address, wanted);
        let index = place.get("index");
        let text = index.map(|index| (index.text(), index.span));
        let index = text.as_ref().map(|(text, span)| (text.as_str(), *span));
        Box::new(unfit(node, wrong, place.span, index))
    }

    /// The places of the settings by which nodes can contradict each other.
    fn places(&self) -> Vec<(Setting, Span)> {
        const KEYS: [&str; 5] = [
            "node_id",
            "sync_period",
            "time_cob_id",
            "heartbeat_consumer",
            "heartbeat_producer",
        ];
        let pdos = ["rpdo", "tpdo"].into_iter().flat_map(|key| {
            let numbers = self.yaml.get(key).map_or(&[][..], Yaml::entries).iter();
            let numbers = numbers.filter_map(|(own, _)| u16::try_from(own.integer()?).ok());
            numbers.map(move |number| Setting::Pdo(key, number))
        });
        let all = KEYS.into_iter().map(Setting::Key).chain(pdos);
        all.filter_map(|setting| {
            let place = match setting {
                Setting::Key(key) => self.yaml.get(key)?,
                // Nodes contradict each other by the CAN-ID of a PDO.
                Setting::Pdo(key, number) => {
                    let (own, pdo) = self.pdo_of(key, number)?;
                    pdo.get("cob_id").unwrap_or(own)
                }
            };
            Some((setting, place.span))
        })
        .collect()
    }

    /// The findings about objects in the mappings of the PDOs that the device cannot map.
    fn unmapped(&self, node: &Node, wanted: &Configuration) -> Vec<Finding> {
        let pdos = [("rpdo", &wanted.rpdo), ("tpdo", &wanted.tpdo)];
        let mut found = Vec::new();
        for (key, number, pdo) in pdos
            .iter()
            .flat_map(|(key, pdos)| pdos.iter().map(|(number, pdo)| (*key, *number, pdo)))
        {
            for (at, address) in pdo.mapping.iter().flatten().enumerate() {
                let entry = self.mapped(key, number, at);
                let span = entry.map(|entry| entry.span).unwrap_or_default();
                found.extend(not_mappable(node, key == "rpdo", *address, span));
            }
        }
        found
    }

    /// The findings about objects below `sdo` that a master cannot write.
    fn read_only(&self, node: &Node, wanted: &Configuration) -> Vec<Finding> {
        let writes = wanted.sdo.iter().enumerate();
        let found = writes.filter_map(|(at, (address, _))| {
            let entry = self.list("sdo").get(at);
            read_only(
                node,
                *address,
                entry.map(|entry| entry.span).unwrap_or_default(),
            )
        });
        found.collect()
    }

    /// The setting that writes an object; the whole section if none does.
    fn place_of_write(&self, address: Address, wanted: &Configuration) -> &'a Yaml {
        let of_pdo = |key| {
            let (number, pdo) = self.pdo_of(key, (address.index & 0x1FF) + 1)?;
            let is_mapping = address.index & 0x200 != 0;
            let own = match address.sub {
                sub if is_mapping => {
                    let mapping = pdo.get("mapping");
                    let entries = mapping.map_or(&[][..], Yaml::list);
                    entries.get(usize::from(sub).wrapping_sub(1)).or(mapping)
                }
                1 => pdo.get("cob_id"),
                2 => pdo.get("transmission"),
                3 => pdo.get("inhibit_time"),
                5 => pdo.get("event_timer").or(pdo.get("event_deadline")),
                6 => pdo.get("sync_start"),
                _ => None,
            };
            Some(own.unwrap_or(number))
        };
        let sdo = wanted.sdo.iter().position(|(own, _)| *own == address);
        let found = match (sdo, address.index) {
            (Some(at), _) => self.list("sdo").get(at),
            (_, 0x100C) => self.yaml.get("guard_time"),
            (_, 0x100D) => self.yaml.get("life_time_factor"),
            (_, 0x1012) => self.yaml.get("time_cob_id"),
            (_, 0x1017) => self.yaml.get("heartbeat_producer"),
            (_, 0x1029) => self.yaml.get("error_behavior"),
            (_, 0x1400..=0x17FF) => of_pdo("rpdo"),
            (_, 0x1800..=0x1BFF) => of_pdo("tpdo"),
            _ => None,
        };
        found.unwrap_or(self.yaml)
    }

    /// A number of a key; `None` if the key is missing.
    fn number<T: TryFrom<i128>>(&self, key: &str) -> Result<Option<T>, Problem> {
        let Some(value) = self.yaml.get(key) else {
            return Ok(None);
        };
        let number = value.integer().and_then(|number| T::try_from(number).ok());
        number.map(Some).ok_or_else(|| self.wrong::<T>(key, value))
    }

    /// The node ID.
    fn node_id(&self) -> Result<Option<u8>, Problem> {
        let Some(value) = self.yaml.get("node_id") else {
            return Ok(None);
        };
        let id = value.integer().and_then(|number| u8::try_from(number).ok());
        let id = id.filter(|id| (1..=127).contains(id));
        id.map(Some)
            .ok_or_else(|| self.wrong_number("node_id", value, Some(127)))
    }

    /// The bit rate in kbit/s; `None` if it is missing or not a number.
    fn bit_rate(&self) -> Option<u32> {
        self.yaml.get("baudrate")?.integer()?.try_into().ok()
    }

    fn real(&self, key: &str) -> Result<Option<f64>, Problem> {
        let Some(value) = self.yaml.get(key) else {
            return Ok(None);
        };
        let real = value.real().map(Some);
        real.ok_or_else(|| self.wrong_number(key, value, None))
    }

    fn flag(&self, key: &str) -> Option<bool> {
        self.yaml.get(key).map(Yaml::is_true)
    }

    fn text(&self, key: &str) -> Option<String> {
        self.yaml.get(key).map(Yaml::text)
    }

    /// The entries below a key, whose own keys and values are numbers.
    fn numbers<T: TryFrom<i128>>(&self, key: &str) -> Result<Vec<(T, u32)>, Problem> {
        let entries = self.yaml.get(key).map_or(&[][..], Yaml::entries).iter();
        let entries = entries.map(|(own, value)| {
            let sub = own.integer().and_then(|sub| T::try_from(sub).ok());
            let number = value
                .integer()
                .and_then(|number| u32::try_from(number).ok());
            Ok((
                sub.ok_or_else(|| self.wrong::<T>(key, own))?,
                number.ok_or_else(|| self.wrong::<u32>(key, value))?,
            ))
        });
        entries.collect()
    }

    fn address(&self) -> Result<Address, Problem> {
        let missing = || missing_key(self.name, "index", "0x2000", self.place);
        let index = self.number("index")?.ok_or_else(missing)?;
        Ok(Address::new(index, self.number("sub_index")?.unwrap_or(0)))
    }

    fn list(&self, key: &str) -> &'a [Yaml] {
        self.yaml.get(key).map_or(&[], Yaml::list)
    }

    fn pdo(&self) -> Result<PdoConfiguration, Problem> {
        let cob_id = match self.text("cob_id").as_deref() {
            None => None,
            Some("auto") => Some(None),
            Some(_) => Some(self.number("cob_id")?),
        };
        let mapping = self.yaml.get("mapping").map(|_| {
            let entries = self.list("mapping").iter();
            entries.map(|yaml| self.part(yaml).address()).collect()
        });
        Ok(PdoConfiguration {
            cob_id,
            transmission: self.number("transmission")?,
            inhibit_time: self.number("inhibit_time")?,
            event_timer: self.number("event_timer")?,
            event_deadline: self.number("event_deadline")?,
            sync_start: self.number("sync_start")?,
            mapping: mapping.transpose()?,
            enabled: self.flag("enabled").unwrap_or(true),
        })
    }

    fn pdos(&self, key: &str) -> Result<Vec<(u16, PdoConfiguration)>, Problem> {
        let entries = self.yaml.get(key).map_or(&[][..], Yaml::entries).iter();
        let pdos = entries.map(|(own, yaml)| {
            let number = own.integer().and_then(|number| u16::try_from(number).ok());
            let number = number.filter(|number| (1..=512).contains(number));
            let number = number.ok_or_else(|| no_pdo(self.name, key, &own.text(), own.span))?;
            Ok((number, self.part(yaml).pdo()?))
        });
        pdos.collect()
    }

    /// The findings about keys of `yaml` that look like one of these. Drivers of ros2_canopen have keys of their own.
    fn misspelled(&self, yaml: &Yaml, known: Keys) -> Vec<Finding> {
        let keys = yaml.entries().iter();
        keys.filter_map(|(key, _)| {
            let owner = owner(self.whole, key.span);
            let name = owner.unwrap_or_else(|| self.name.into());
            let has = |key: &str| yaml.get(key).is_some();
            misspelled_key(&name, &key.text(), known, key.span, &has)
        })
        .collect()
    }

    /// The findings about texts in `yaml` where a flag is due.
    fn texts_of_flags(&self, yaml: &Yaml, flags: &[&str]) -> Vec<Finding> {
        let values = flags.iter().filter_map(|key| Some((*key, yaml.get(key)?)));
        let texts = values.filter(|(_, value)| value.is_words());
        let found = texts.filter_map(|(key, value)| {
            let owner = owner(self.whole, value.span);
            let name = owner.unwrap_or_else(|| self.name.into());
            text_of_flag(&name, key, &value.text(), value.span)
        });
        found.collect()
    }

    /// The findings about misspelled keys and flags of a slave.
    fn misspelled_of_slave(&self) -> Vec<Finding> {
        let mut findings = self.misspelled(self.yaml, OF_SLAVE);
        findings.extend(self.texts_of_flags(self.yaml, FLAGS));
        for (_, pdo) in ["rpdo", "tpdo"]
            .iter()
            .filter_map(|key| self.yaml.get(key))
            .flat_map(Yaml::entries)
        {
            findings.extend(self.misspelled(pdo, OF_PDO));
            findings.extend(self.texts_of_flags(pdo, &["enabled"]));
        }
        findings
    }

    fn configuration(&self) -> Result<Configuration, Problem> {
        let sdo = self.list("sdo").iter().map(|yaml| {
            let one = self.part(yaml);
            Ok((one.address()?, one.number("value")?.unwrap_or(0)))
        });
        Ok(Configuration {
            dcf_path: self.text("dcf_path"),
            revision_number: self.number("revision_number")?,
            serial_number: self.number("serial_number")?,
            time_cob_id: self.number("time_cob_id")?,
            heartbeat_multiplier: self.real("heartbeat_multiplier")?,
            heartbeat_consumer: self.flag("heartbeat_consumer").unwrap_or(false),
            heartbeat_producer: self.number("heartbeat_producer")?,
            retry_factor: self.number("retry_factor")?,
            guard_time: self.number("guard_time")?,
            life_time_factor: self.number("life_time_factor")?,
            error_behavior: self.numbers("error_behavior")?,
            rpdo: self.pdos("rpdo")?,
            tpdo: self.pdos("tpdo")?,
            boot: self.flag("boot"),
            mandatory: self.flag("mandatory"),
            reset_communication: self.flag("reset_communication"),
            software_file: self.text("software_file").unwrap_or_default(),
            software_version: self.number("software_version")?.unwrap_or(0),
            restore_configuration: self.number("restore_configuration")?.unwrap_or(0),
            sdo: sdo.collect::<Result<_, Problem>>()?,
        })
    }

    /// The node, with the writes of its settings; what is wrong with the settings is added to the findings.
    fn node(
        &self,
        load: &dyn Fn(&str) -> Result<od_eds::Description, String>,
        master: &Master,
        settings: &mut ProjectSettings,
        findings: &mut Vec<Finding>,
    ) -> Result<Node, Problem> {
        let name = self.name;
        let dcf = self.yaml.get("dcf");
        let dcf = dcf.ok_or_else(|| missing_key(name, "dcf", "device.eds", self.place))?;
        let path = dcf.text();
        let description = load(&path).map_err(|why| unusable_file(name, &path, &why, dcf.span))?;
        let id = self
            .node_id()?
            .or(description.commissioned_node_id())
            .filter(|id| (1..=127).contains(id));
        let id = id.ok_or_else(|| missing_key(name, "node_id", "2", self.place))?;
        let mut node = Node::new(name.into(), id, description);
        let wanted = self.configuration()?;
        findings.extend(self.unmapped(&node, &wanted));
        findings.extend(self.read_only(&node, &wanted));
        configure(&mut node, &wanted, settings)
            .map_err(|wrong| self.unfit(&wrong, &node, &wanted))?;
        let place = |address| self.place_of_write(address, &wanted).span;
        findings.extend(unfit_values(&node, &place));
        consume_heartbeat(master, &mut node).map_err(|wrong| self.unfit(&wrong, &node, &wanted))?;
        (node.place, node.places) = (self.place, self.places());
        Ok(node)
    }

    /// The settings of a project for all nodes.
    fn settings(&self) -> Result<ProjectSettings, Problem> {
        let default = ProjectSettings::default();
        Ok(ProjectSettings {
            dcf_path: self.text("dcf_path").unwrap_or_default(),
            heartbeat_multiplier: self
                .real("heartbeat_multiplier")?
                .unwrap_or(default.heartbeat_multiplier),
            retry_factor: self.number("retry_factor")?.unwrap_or(default.retry_factor),
            ..default
        })
    }

    /// The findings about the keys of the master.
    fn findings_of_master(&self) -> Vec<Finding> {
        let mut findings = self.misspelled(self.yaml, OF_MASTER);
        findings.extend(self.texts_of_flags(self.yaml, FLAGS));
        if let Some(rate) = self.yaml.get("baudrate") {
            findings.extend(unusual_bit_rate(&rate.text(), self.bit_rate(), rate.span));
        }
        let period = self.yaml.get("sync_period").and_then(Yaml::integer);
        let of_sync = ["sync_window", "sync_overflow"].into_iter();
        let of_sync = of_sync.filter(|_| period.unwrap_or(0) <= 0);
        findings.extend(of_sync.filter_map(|key| {
            let value = self.yaml.get(key)?;
            (value.integer() != Some(0)).then(|| no_sync(key, value.span))
        }));
        findings
    }

    fn master(&self, settings: &ProjectSettings) -> Result<Master, Problem> {
        let default = Master::default();
        let number = |key, default: u32| Ok::<u32, Problem>(self.number(key)?.unwrap_or(default));
        let mut identity = [0; 4];
        for (at, key) in [
            "vendor_id",
            "product_code",
            "revision_number",
            "serial_number",
        ]
        .into_iter()
        .enumerate()
        {
            identity[at] = number(key, 0)?;
        }
        let mut error_behavior = default.error_behavior;
        for (sub, value) in self.numbers::<u8>("error_behavior")? {
            error_behavior.retain(|(known, _)| *known != sub);
            error_behavior.push((sub, value));
        }
        let flags = [
            (self.flag("start_all_nodes").unwrap_or(false), 0x02),
            (!self.flag("start").unwrap_or(true), 0x04),
            (!self.flag("start_nodes").unwrap_or(true), 0x08),
            (self.flag("reset_all_nodes").unwrap_or(false), 0x10),
            (self.flag("stop_all_nodes").unwrap_or(false), 0x40),
        ];
        let flags = flags
            .iter()
            .filter(|(is_set, _)| *is_set)
            .map(|(_, bit)| bit);
        Ok(Master {
            node_id: match self.number("node_id")? {
                // dcfgen's number of a master without a node ID.
                Some(255) => 255,
                _ => self.node_id()?.unwrap_or(default.node_id),
            },
            bit_rate: self.bit_rate().unwrap_or(default.bit_rate),
            identity,
            sync_period: number("sync_period", 0)?,
            sync_window: number("sync_window", 0)?,
            sync_overflow: number("sync_overflow", 0)?,
            time_cob_id: number("time_cob_id", default.time_cob_id)?,
            emcy_inhibit_time: number("emcy_inhibit_time", 0)?,
            heartbeat_multiplier: self
                .real("heartbeat_multiplier")?
                .unwrap_or(settings.heartbeat_multiplier),
            consumes_heartbeat: self.flag("heartbeat_consumer").unwrap_or(true),
            heartbeat_producer: number("heartbeat_producer", 0)?,
            error_behavior,
            nmt_inhibit_time: number("nmt_inhibit_time", 0)?,
            startup: flags.sum(),
            boot_time: number("boot_time", 0)?,
        })
    }
}

/// The sections of the slaves, with their names. In the form of ros2_canopen each is a node below `nodes` with the keys of
/// `defaults` that it does not have itself (as `cogen_dcf` merges them: key by key, not below a key).
fn slaves(whole: &Yaml) -> Vec<(Yaml, Yaml)> {
    let is_own = |name: &str| matches!(name, "master" | "options") || name.starts_with('.');
    // A section `nodes` with a file is a slave of this name.
    let nodes = whole
        .get("nodes")
        .filter(|nodes| nodes.get("dcf").is_none());
    let Some(nodes) = nodes else {
        let all = whole.entries().iter();
        return all
            .filter(|(name, _)| !is_own(&name.text()))
            .cloned()
            .collect();
    };
    let defaults = whole.get("defaults").map_or(&[][..], Yaml::entries);
    let merged = |yaml: &Yaml| {
        let missing = defaults
            .iter()
            .filter(|(key, _)| yaml.get(&key.text()).is_none());
        let own = yaml.entries().iter();
        yaml.with(own.chain(missing).cloned().collect())
    };
    let all = nodes.entries().iter();
    all.map(|(name, yaml)| (name.clone(), merged(yaml)))
        .collect()
}

/// The name of the section or the node that a place is in: keys of `defaults` and of an anchor belong to several nodes.
fn owner(whole: &Yaml, place: Span) -> Option<String> {
    let nodes = whole.get("nodes").map_or(&[][..], Yaml::entries);
    let all = whole.entries().iter().chain(nodes);
    let above = all.filter(|(name, _)| name.span.start <= place.start);
    let last = above.max_by_key(|(name, _)| name.span.start)?;
    Some(last.0.text())
}

/// Reads a project; `load` reads the description at a path.
pub(super) fn read(
    text: &str,
    load: &dyn Fn(&str) -> Result<od_eds::Description, String>,
) -> Network {
    let (whole, twice) = match Yaml::read(text) {
        Ok(read) => read,
        Err((why, at)) => return Network::of_error(unreadable(&why, at)),
    };
    let Some(master) = whole.get("master") else {
        return Network::of_error(missing_section("`master`"));
    };
    let twice = twice.iter().map(|one| {
        let key = &one.key;
        key_twice(&key.text(), key.span, one.first, one.is_line, one.is_same)
    });
    let mut findings: Vec<Finding> = twice.collect();
    let mut problems = Vec::new();
    let mut settings = ProjectSettings::default();
    if let Some(yaml) = whole.get("options") {
        let own = Section {
            name: "options",
            place: yaml.span,
            yaml,
            whole: &whole,
        };
        findings.extend(own.misspelled(yaml, OF_OPTIONS));
        match own.settings() {
            Ok(own) => settings = own,
            Err(problem) => problems.push(problem),
        }
    }
    let own = Section {
        name: "master",
        place: master.span,
        yaml: master,
        whole: &whole,
    };
    let master_places = (master.span, own.places());
    findings.extend(own.findings_of_master());
    let master = own.master(&settings).unwrap_or_else(|problem| {
        problems.push(problem);
        Master::default()
    });
    let mut nodes = Vec::new();
    // Where the misspelled keys are that are reported.
    let mut seen = BTreeSet::new();
    for (key, yaml) in slaves(&whole) {
        if problems.len() > MAX_NODES {
            break;
        }
        let name = key.text();
        let section = Section {
            name: &name,
            place: key.span,
            yaml: &yaml,
            whole: &whole,
        };
        // The keys of `defaults` and of an alias are those of several nodes.
        let misspelled = section.misspelled_of_slave().into_iter();
        let is_new = |own: &Finding| own.span().is_none_or(|span| seen.insert(span.start));
        findings.extend(misspelled.filter(is_new));
        match section.node(load, &master, &mut settings, &mut findings) {
            Ok(node) => nodes.push(node),
            Err(problem) => problems.push(problem),
        }
    }
    let is_complete = problems.is_empty();
    findings.extend(problems.into_iter().map(|problem| *problem));
    Network {
        master: Some(master),
        master_places,
        nodes,
        findings,
        is_complete,
        ..Network::default()
    }
}
