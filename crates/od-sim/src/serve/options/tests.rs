//! Arguments of a program that runs a bench.

use super::*;

fn parsed(text: &str) -> Result<Options, String> {
    parse(text.split_whitespace().map(str::to_owned))
}

#[test]
fn arguments_are_read_with_a_blank_or_an_equals_sign() {
    let options = parsed(
        "--node-id 5 --node-id=0x06 --node-id none --serial 0x1268 --link slcan:pty --slcan 127.0.0.1:0 --rpm -60 \
         --position=79592h --domain-size 64KiB --bitrate 125000 --eeprom a.bin --eeprom-reset --quiet --control unix:a \
         --log b.log",
    )
    .expect("options");
    assert_eq!(options.node_ids, [NodeId::new(5), NodeId::new(6), None]);
    assert_eq!(options.serials, [0x1268]);
    assert_eq!(options.links, [Link::slcan("127.0.0.1:0"), Link::Pty]);
    assert_eq!(options.rpm, Some(-60.0));
    assert_eq!(options.position, Some(0x79592));
    assert_eq!(options.bitrate, 125_000);
    assert_eq!(options.domain_size, 65_536);
    assert_eq!(options.eeproms, [PathBuf::from("a.bin")]);
    assert_eq!(options.control, ControlAddress::parse("unix:a").ok());
    assert!(options.quiet && !Options::default().quiet);
    assert!(options.eeprom_reset);
    assert_eq!(parsed(""), Ok(Options::default()));
}

#[test]
fn a_wrong_argument_is_named() {
    for (text, named) in [
        ("5", "`5`"),
        ("--speed 5", "`--speed`"),
        ("--rpm", "`--rpm`"),
        ("--quiet=yes", "`--quiet` has no value"),
        ("--log a.trc", ".pcapng"),
        ("--rpm fast", "`fast`"),
        ("--node-id 128", "1 to 127"),
        ("--serial 4294967296", "32 bits"),
        ("--rpm 1 --rpm 2", "twice"),
        ("--domain-size 1GB", "1MiB"),
        ("--seed 1 --position 2", "`--seed`"),
        ("--position 2 --seed 1", "`--position`"),
    ] {
        let why = parsed(text).expect_err(text);
        assert!(why.contains(named), "{text}: {why}");
    }
}
