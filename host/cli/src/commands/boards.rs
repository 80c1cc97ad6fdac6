//! `halfrow boards`

use std::time::Duration;

use clap::Args;
use serde::Serialize;

use super::{Context, Failure, print};
use crate::bitstreams::{BOARDS, BitstreamBoard};
use crate::document::print_result;
use crate::exit::Exit;
use halfrow::link::discovery::{self, Access, Answer, Found};
use halfrow::link::kinds::{Form, KINDS};
use halfrow::target::{BoardKind, Target, TargetError};
use halfrow::words::{count, plain_lines};

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Look at these targets instead of searching
    #[arg(value_name = "TARGET", value_parser = crate::arguments::board::target())]
    targets: Vec<Target>,
    /// Greet what is free: some thirty bytes are written to it, up to six times, whatever it is
    #[arg(long)]
    ask: bool,
}

/// A kind of board that is not a device, in one of the forms of its target.
#[derive(Serialize)]
struct BuiltIn {
    #[serde(flatten)]
    form: Form,
    kind: BoardKind,
}

fn built_in() -> Vec<BuiltIn> {
    let kinds = KINDS.iter().filter(|kind| kind.board != BoardKind::Hardware);
    kinds.flat_map(|kind| kind.forms.iter().map(|&form| BuiltIn { form, kind: kind.board })).collect()
}

/// A line of the list.
#[derive(Serialize)]
#[serde(untagged)]
enum Entry<'a> {
    Device(&'a Found),
    BuiltIn(BuiltIn),
}

/// The whole list.
#[derive(Serialize)]
struct Boards<'a> {
    boards: &'a [Entry<'a>],
    bitstreams: &'a [BitstreamBoard],
}

pub(super) fn run(arguments: &Arguments, context: &Context) -> Result<Exit, Failure> {
    arguments.targets.iter().try_for_each(halfrow::link::check).map_err(Failure::call)?;
    let mut devices: Vec<Found> = if arguments.targets.is_empty() {
        discovery::find()
    } else {
        arguments.targets.iter().map(Found::named).collect()
    };
    if arguments.ask {
        ask_all(&mut devices, halfrow::probe).map_err(Failure::call)?;
    }
    let mut entries: Vec<_> = devices.iter().map(Entry::Device).collect();
    let mut bitstreams: &[BitstreamBoard] = &[];
    if arguments.targets.is_empty() {
        entries.extend(built_in().into_iter().map(Entry::BuiltIn));
        bitstreams = &BOARDS;
    }
    if context.json {
        print_result("boards", Boards { boards: &entries, bitstreams })?;
    } else {
        let lines: Vec<_> = entries.iter().map(text).chain(bitstreams.iter().map(bitstream_text)).collect();
        print(&lines.join("\n"))?;
    }
    Ok(Exit::Pass)
}

/// How long udev may take until a serial port has its names and its owner again.
const UDEV: Duration = Duration::from_secs(2);

/// Asks every device that can be opened. Serial ports come first: asking a chip takes its ports away, and if they were asked after it,
/// udev would not have seen yet that they are back. Nor would it for the command that is called next, so that is awaited.
fn ask_all(devices: &mut [Found], probe: impl Fn(&Target) -> Answer) -> Result<(), TargetError> {
    let mut asked: Vec<_> = devices.iter_mut().filter(|device| device.is_open_to_us()).collect();
    asked.sort_by_key(|device| device.takes_ports());
    let takes_ports = asked.last().is_some_and(|device| device.takes_ports());
    asked.into_iter().try_for_each(|device| ask(device, &probe))?;
    if takes_ports {
        discovery::await_ports(devices, UDEV);
    }
    Ok(())
}

/// Asks `device` whether it is a board. If it answers at another target than the port's own, it is listed under that one.
fn ask(device: &mut Found, probe: impl Fn(&Target) -> Answer) -> Result<(), TargetError> {
    let mut answer = probe(&device.target.parse()?);
    if matches!(answer, Answer::Failed { .. })
        && let Some(further) = device.further_target()
    {
        answer = probe(&further.parse()?);
        if matches!(answer, Answer::Board { .. } | Answer::Held | Answer::Foreign { .. }) {
            device.target = further;
        }
    }
    device.answer = Some(answer);
    Ok(())
}

fn text(entry: &Entry<'_>) -> String {
    let device = match entry {
        Entry::BuiltIn(BuiltIn { form: Form { target, summary }, .. }) => {
            return format!("{target:<12} {summary}");
        }
        Entry::Device(device) => device,
    };
    let mut lines = vec![device.target.clone(), format!("    {}", device.summary)];
    let names = device.device.iter().chain(&device.names).map(|name| name.display().to_string());
    let names: Vec<_> = names.collect();
    if !names.is_empty() {
        lines.push(format!("    {}", names.join(", ")));
    }
    lines.push(format!("    {}", state(device)));
    plain_lines(lines)
}

fn bitstream_text(board: &BitstreamBoard) -> String {
    let BitstreamBoard { name, device, links, build, bitstream, target, .. } = board;
    let links = links.join(", ");
    format!(
        "\n{name}\n    a board with a bitstream of this project: {device}, connects by {links}\n    build: {build}\n    \
         load:  halfrow load {bitstream}\n    judge: halfrow verify --board {target}"
    )
}

/// The result of asking, or else of looking at the device from outside.
fn state(device: &Found) -> String {
    match &device.answer {
        Some(Answer::Board { name, .. }) => return format!("a halfrow board answers: {name}"),
        Some(Answer::Held) => return "a halfrow board answers, which another host holds".to_owned(),
        Some(Answer::Foreign { reason }) => return format!("something else answers: {reason}"),
        Some(Answer::Silent) => return "nothing answers".to_owned(),
        Some(Answer::Babble { bytes }) => {
            return format!(
                "something talks that is no halfrow board, or is one at another rate: {} came, no answer among them",
                count(*bytes, "byte")
            );
        }
        Some(Answer::Busy) => return "busy: it is open elsewhere".to_owned(),
        Some(Answer::Failed { reason }) => {
            let free = if device.access == Access::Free { "free, but " } else { "" };
            return format!("{free}cannot be asked: {reason}");
        }
        None => {}
    }
    match &device.access {
        Access::Free => "free; --ask tells whether a board answers".to_owned(),
        Access::Busy { holders } => {
            let known: Vec<_> = holders.iter().map(ToString::to_string).collect();
            let by = if known.is_empty() { "another program".to_owned() } else { known.join(" and ") };
            format!("busy: {by} has it open")
        }
        Access::Denied { remedy } => format!("you may not open it; {remedy}"),
        Access::Missing => "is not there; check that the board is plugged in and powered".to_owned(),
        Access::Unknown => "unknown; --ask tells whether a board answers".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use std::cell::RefCell;

    use halfrow::link::{Holder, UsbDevice};

    use super::*;

    /// As a port behind an FT231X looks, where a board answers to `by` alone.
    fn asked(by: &str) -> Found {
        let usb = UsbDevice {
            vendor_id: 0x0403,
            product_id: 0x6015,
            device_version: 0x1000,
            manufacturer: None,
            product: None,
            serial: None,
            interface: None,
        };
        let port = "serial:/dev/ttyUSB99".parse().unwrap();
        let mut device = Found { usb: Some(usb), ..Found::named(&port) };
        let board = || Answer::Board { name: "ULX3S".to_owned(), datapath: 1 };
        let probe = |target: &Target| match target.to_string() {
            target if target == by => board(),
            target if target == "serial:/dev/ttyUSB99" => {
                Answer::Failed { reason: "no such rate".to_owned() }
            }
            _ => Answer::Silent,
        };
        ask(&mut device, probe).unwrap();
        device
    }

    /// The chips are found first, and stay first in the list.
    #[test]
    fn serial_ports_are_asked_before_the_chips_that_take_them_away() {
        let targets = ["usb:HR1", "usb:HR2", "serial:/dev/null", "tcp:bench:3001"];
        let mut devices =
            targets.map(|target| Found { access: Access::Free, ..Found::named(&target.parse().unwrap()) });
        let asked = RefCell::new(Vec::new());
        let probe = |target: &Target| {
            asked.borrow_mut().push(target.to_string());
            Answer::Silent
        };
        ask_all(&mut devices, probe).unwrap();
        assert_eq!(asked.into_inner(), ["serial:/dev/null", "tcp:bench:3001", "usb:HR1", "usb:HR2"]);
        assert_eq!(devices.map(|device| device.target), targets);
    }

    /// Only root sees the programs of other users.
    #[test]
    fn a_device_that_somebody_unknown_has_open_is_busy_all_the_same() {
        let port = "serial:/dev/ttyUSB99".parse().unwrap();
        let mut device = Found { access: Access::Busy { holders: Vec::new() }, ..Found::named(&port) };
        assert_eq!(state(&device), "busy: another program has it open");
        let holders = vec![Holder { process: 7, program: "sh".to_owned() }];
        device.access = Access::Busy { holders };
        assert_eq!(state(&device), "busy: sh (process 7) has it open");
    }

    /// Whoever builds a device or a program calls it anything.
    #[test]
    fn a_device_begins_no_line_and_conceals_none() {
        let name = "\u{1b}[8mq\nPASS";
        let port = "serial:/dev/ttyUSB99".parse().unwrap();
        let holders = vec![Holder { process: 7, program: name.to_owned() }];
        let device = Found {
            target: format!("serial:/dev/{name}"),
            summary: name.to_owned(),
            names: vec![format!("/dev/serial/{name}").into()],
            access: Access::Busy { holders },
            ..Found::named(&port)
        };
        let spelt = "\\u{1b}[8mq\\nPASS";
        let expected = [
            format!("serial:/dev/{spelt}"),
            format!("    {spelt}"),
            format!("    /dev/ttyUSB99, /dev/serial/{spelt}"),
            format!("    busy: {spelt} (process 7) has it open"),
        ];
        assert_eq!(text(&Entry::Device(&device)), expected.join("\n"));
    }

    #[test]
    fn a_board_is_called_by_the_target_that_it_answered_to() {
        let by = "serial:/dev/ttyUSB99,board=ulx3s";
        let found = asked(by);
        assert_eq!(text(&Entry::Device(&found)).lines().next(), Some(by));
        assert!(matches!(found.answer, Some(Answer::Board { .. })), "{found:?}");
        let silent = asked("nothing");
        assert_eq!((silent.target.as_str(), silent.answer), ("serial:/dev/ttyUSB99", Some(Answer::Silent)));
    }
}
