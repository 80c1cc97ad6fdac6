//! Poor links: what can be repaired is repaired, and the rest is an ERROR. A bad cable is never a FAIL.

use super::expect;
use crate::scenario::{On, OnSim, Scenario};

/// Links that lose or spoil something, but not too much.
pub const REPAIRED_LINKS: &[Scenario] = &[
    passes("a flipped bit in a row", ",fault=flip,byte=60000", SMALL).on_sim(OnSim::Stepped),
    passes("a flipped bit in a packet to the board", ",fault=flip,packet=60,toward=board", SMALL)
        .on_sim(OnSim::Stepped),
    passes("a flipped bit in a packet to the host", ",fault=flip,packet=60,toward=host", SMALL)
        .on_sim(OnSim::Nothing),
    passes("bits that flip now and then", ",fault=flip,rate=5e-5,seed=2", SMALL),
    passes("bits that flip often", ",fault=flip,rate=1e-4,seed=4", SMALL).on_sim(OnSim::Nothing),
    passes("a lost byte", ",fault=drop,byte=50000", SMALL).on_sim(OnSim::Stepped),
    passes("a lost greeting", ",fault=drop,packet=0,toward=board", SMALL).on_sim(OnSim::Stepped),
    passes("a lost answer to the greeting", ",fault=drop,packet=0,toward=host", SMALL).on_sim(OnSim::Nothing),
    passes("a lost packet of the tables", ",fault=drop,packet=15,toward=board", SMALL).on_sim(OnSim::Stepped),
    passes("lost packets", ",fault=drop,packet=100", SMALL).on_sim(OnSim::Nothing),
    passes("bytes that get lost", ",fault=drop,rate=5e-5,seed=4", SMALL).on_sim(OnSim::Stepped),
    passes("a byte that comes twice", ",fault=duplicate,byte=50000,toward=host", SMALL)
        .on_sim(OnSim::Nothing),
    passes("bytes that come twice", ",fault=duplicate,rate=5e-5,seed=5", SMALL).on_sim(OnSim::Stepped),
    passes("rows that get lost whole", ",fault=lose,rate=0.01,seed=8", SMALL),
    passes("a packet that ends early", ",fault=truncate,packet=50,toward=host", SMALL).on_sim(OnSim::Nothing),
    passes("packets that end early", ",fault=truncate,rate=0.01,seed=6", SMALL),
];

/// Links that stall for a while, deliver some things twice, or change their order, which costs time at most.
pub const SLOW_LINKS: &[Scenario] = &[
    passes("a packet that comes twice", ",fault=duplicate,packet=70", SMALL).on_sim(OnSim::Stepped),
    passes("a greeting that comes twice", ",fault=duplicate,packet=0", SMALL).on_sim(OnSim::Stepped),
    passes("packets that overtake each other", ",fault=reorder,rate=0.005,seed=7", SMALL)
        .on_sim(OnSim::Stepped),
    passes("a tenth of a second of silence", ",fault=stall,seconds=0.1", SMALL).on_sim(OnSim::Nothing),
    passes("a second of silence", ",fault=stall,packet=90,seconds=1,toward=host", SMALL)
        .on_sim(OnSim::Stepped),
    passes("three seconds of silence again and again", ",fault=stall,every=60000,seconds=3", SMALL)
        .on_sim(OnSim::Nothing),
];

/// How a run ends over a link that spoils most of what it carries.
const POOR: &[&str] =
    &["no answer to", "the link is too poor to judge a board over", "did not come back in 8 tries"];

/// Links over which nothing can be judged.
pub const HOPELESS_LINKS: &[Scenario] = &[
    stops("no byte gets through", ",fault=drop,rate=1", "no answer to HELLO in 6 tries"),
    stops("no answer gets through", ",fault=drop,rate=1,toward=host", "no answer to HELLO in 6 tries"),
    stops("bits that flip all the time", ",fault=flip,rate=1e-2,seed=1", "no answer to ECHO in 8 tries")
        .or_when_late(POOR),
    stops("bits that flip far too often", ",fault=flip,rate=1e-3,seed=1", "no answer to ECHO in 8 tries")
        .or_when_late(POOR),
    stops("bytes that get lost far too often", ",fault=drop,rate=1e-3", "no answer to ECHO in 8 tries")
        .or_when_late(POOR),
    stops(
        "bytes that come twice far too often",
        ",fault=duplicate,rate=1e-3",
        "no answer to ECHO in 8 tries",
    )
    .or_when_late(POOR),
    stops(
        "packets that end early far too often",
        ",fault=truncate,rate=0.2",
        "the link is too poor to judge a board over",
    )
    .or_when_late(POOR),
    stops(
        "a cable that was never plugged in",
        ",fault=disconnect,byte=0",
        "the link broke while waiting for the answer to HELLO",
    ),
    stops("a cable that was pulled", ",fault=disconnect,packet=90", "the link broke while waiting for row")
        .or_when_late(&["the link broke while waiting for the answer"]),
    stops("a cable pulled at the end", ",fault=disconnect,packet=280,toward=host", "the link broke"),
    stops("no row gets through", ",fault=lose,size=150,rate=1", "no answer to"),
    stops("a minute of silence", ",fault=stall,packet=20,seconds=60", "no answer to").or_when_late(POOR),
    stops("a minute of silence in a frame", ",fault=stall,packet=90,seconds=60", "no answer to")
        .or_when_late(POOR),
];

const SMALL: &[&str] = &["--width", "128", "--height", "16"];

const fn passes(name: &'static str, options: &'static str, arguments: &'static [&'static str]) -> Scenario {
    super::passes(name, options, arguments).on(On::OwnWire)
}

const fn stops(name: &'static str, options: &'static str, sentence: &'static str) -> Scenario {
    expect("ERROR", 3, name, options, SMALL, sentence).on(On::OwnWire)
}
