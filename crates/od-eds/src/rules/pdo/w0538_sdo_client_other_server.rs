use alloc::format;
use alloc::vec::Vec;

use crate::finding::{Check, Finding, Fixability, Rule};
use crate::fix::Fix;
use crate::subject::{Object, start_number};
use od_model::Address;

pub(crate) static W0538: Rule = Rule {
    title: "COB-ID of an SDO client is that of another server",
    why: "The client asks the node of the COB-ID, and a tool that reads sub-index 3 takes the response for that of another node.",
    source: "CiA 301, SDO client parameter and predefined connection set",
    says: "CAN-ID {id:03X}h is that of the default SDO of node {node}, but sub-index 3 is {server}",
    help: "write `0x{right:X}`{fix}, or node ID {node} in sub-index 3",
    fixability: Fixability::Unsafe,
    check: Check::Object(check),
    ..Rule::of("W0538")
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    if !matches!(object.index, 0x1280..=0x12FF) {
        return;
    }
    let at = |sub| start_number(object.description, Address::new(object.index, sub));
    let Some(server) = at(3).filter(|server| (1..=127).contains(&server.value)) else {
        return;
    };
    for (sub, base) in [(1, 0x600_u64), (2, 0x580)] {
        let Some(given) = at(sub).filter(|given| given.value >> 29 == 0) else {
            continue;
        };
        let node = given.value.wrapping_sub(base);
        if (1..=127).contains(&node) && node != server.value {
            let address = Address::new(object.index, sub);
            let finding = W0538.on(object, given.span).about(address);
            let finding = finding.fact("id", given.value).fact("node", node);
            let finding = finding.fact("server", server.value);
            let right = base + server.value;
            let finding = finding.fact("right", right);
            let finding =
                finding.fix(Fix::unsafe_fix().replace(given.span, format!("0x{right:X}")));
            findings.push(finding.related(server.span, "node ID of the server"));
        }
    }
}
