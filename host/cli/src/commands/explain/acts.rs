//! What to do about errors whose message does not end in such an act: because it is filled in when the error happens, belongs to
//! another error, or is missing.

use halfrow::result::{Parameters, split_remedy};

/// What to do where tables of a station or of a plant contradict its records.
const MEND_TABLES: &str = "first repair the records that `check` names; if this is still reported, put back a copy \
                           of the database: station.db, or the plant's";

/// What to do where the cause says it.
const CAUSE: &str = "do what its cause says, which has a code of its own";

/// What to do about a port or chip that another program has.
const HELD: &str =
    "end the program that holds it, which the message names if this user may know, or wait until it is done";

/// What to do about a port or chip that this user may not open.
const NOT_PERMITTED: &str = "do what the message says: join a group, install scripts/70-halfrow.rules as docs/boards.md says, or ask \
                             root for access";

/// Each code with its act, in the order of the codes.
pub(super) const ACTS: &[(&str, &str)] = &[
    ("audit-contradicts", MEND_TABLES),
    (
        "board-of-other-datapath",
        "load a bitstream of a datapath that this halfrow knows, or install a halfrow that knows the board's",
    ),
    ("board-option-wrong", CAUSE),
    (
        "builtin-frame-unknown",
        "use one of the names in the message, which are those of the files that `halfrow frames` writes",
    ),
    ("call-refused", "change the call as its sentence says"),
    ("camera-impossible", "correct the figure that its sentence names, or calibrate the lens again"),
    (
        "code-unknown",
        "choose a code that `halfrow codes` or `halfrow-station codes` lists, or a word at the left of a result",
    ),
    ("command-failed", "do what the end of its sentence says, then run again"),
    ("evidence-not-written", "make room on the station's disk, then test the board again"),
    (
        "evidence-unreadable",
        "try again, run as the station's user, or bring the file back from a copy of its folder",
    ),
    ("fault-not-made", CAUSE),
    ("fault-parameter-wrong", CAUSE),
    (
        "fault-without-effect",
        "give the run what its sentence says is missing, or choose another fault of `halfrow faults`",
    ),
    (
        "file-not-finished",
        "keep or remove the file next to that place, which the message names, mend what its cause says, and write \
         the file again",
    ),
    ("foreign-cause", "do what the error in front of it says: it has a code of its own"),
    (
        "frame-does-not-fit-tables",
        "use a frame of the tables' size and depth, or make tables for the frame's",
    ),
    (
        "frame-file-has-more",
        "check width, height and layout, cut off what pads the rows, or split a file of several frames",
    ),
    ("frame-file-not-understood", CAUSE),
    ("frame-format-not-supported", "convert the file to PGM, PNG, TIFF or DNG as the message says"),
    ("frame-impossible", "correct the size that its sentence names, or crop or pad the frame"),
    ("frame-not-encoded", "do what its cause says, or write another format"),
    ("frame-of-other-depth", "give the depth that the file has, or scale its samples to 8, 10 or 12 bits"),
    (
        "frame-of-other-size",
        "use a frame of COLUMNS x ROWS, or make tables for WIDTH x HEIGHT with `halfrow tables`",
    ),
    ("frame-unfit", "use a frame of the tables' size and depth, or make tables for the frame's"),
    (
        "frames-too-large-for-board",
        "use frames and tables that the board takes, or load a bitstream for larger ones",
    ),
    ("geometry-impossible", "correct the width, height or radius that its sentence names"),
    ("given-secret-open", "run the `chmod` that the message names, as the user that it names"),
    ("golden-error-unseen", "rebuild halfrow, and if that does not help, test the computer's memory"),
    ("golden-frame-wrong", "rebuild halfrow, and if that does not help, test the computer's memory"),
    ("golden-row-wrong", "rebuild halfrow, and if that does not help, test the computer's memory"),
    ("golden-values-not-made", "rebuild halfrow, and if that does not help, report it with its cause"),
    ("grid-shape-impossible", "give a spacing of entries within the ranges that the message names"),
    ("input-would-be-overwritten", "name another place with OPTION: an input is never overwritten"),
    ("io-already-there", "name another place, or take away what is there"),
    ("io-ends-early", "copy or make the file again: its end is missing"),
    ("io-failed", "look up `os_error` on this system, mend what it says, then run again"),
    ("io-no-space", "free some space on that disk, or name another place"),
    ("io-not-found", "check the name, and that the device is plugged in or the disk mounted"),
    ("io-not-permitted", "ask for the right to it, or run as a user who has it"),
    ("io-pipe-closed", "look why the program at the other end ended, then run again"),
    ("io-too-late", "check the cable and what is at the other end, then run again"),
    ("io-wrong-data", "copy or make the file again: its bytes are not what they must be"),
    (
        "kernel-impossible",
        "correct the weights that its sentence names, or use a named kernel such as hermite",
    ),
    ("kernel-not-found", "correct the path, or use a named kernel such as hermite"),
    ("lane-not-checked", "do what the end of its sentence says"),
    (
        "lens-file-of-other-shape",
        "do what its cause says: calibrate with frames of this shape, or give the lens pitch and the optical centre",
    ),
    ("lens-file-unfit", "do what its cause says, or make the frames smaller"),
    ("lens-file-wrong", "mend the file as its cause says, or calibrate the lens again"),
    (
        "lens-impossible",
        "correct the figure that its sentence names, from the data sheet of the lens or the sensor",
    ),
    ("lines-file-malformed", "write the circle and the lines as its sentence shows"),
    (
        "link-broke",
        "do what its cause says, which has a code of its own: most often check the cable and the board's power, then run again",
    ),
    (
        "link-test-broke-off",
        "do what its cause says, then run again: the board or its link chip may be wrong",
    ),
    ("link-without-board", "plug the board in at the far end, and check the device that its ser2net names"),
    (
        "loader-failed",
        "check that the board is plugged in and powered, that you may open it (scripts/70-halfrow.rules), that it is the board that \
         was named, and that its FPGA is, by the print on it, the one that the file was built for, or load the file by hand with \
         `OTHER`",
    ),
    ("mem-depth-unknown", "make the file again with `halfrow tables` and --bits 8, 10 or 12"),
    ("mem-file-wrong", "do what its cause says, or make the file again with `halfrow tables`"),
    ("message-malformed", "load a bitstream that this halfrow is made for"),
    (
        "no-answer",
        "check that the board is powered and loaded, that the target's rate is the board's, and, at a serial port that is used with \
         RTS/CTS, that the board drives CTS: if it has no such line, as the ULX3S, say flow=none",
    ),
    (
        "ocam-inverse-contradicts",
        "export the file again: its polynomials are of two calibrations or in another order",
    ),
    ("ocam-sign-wrong", "change the signs of all coefficients if z counts forwards in your program"),
    (
        "option-is-no-time",
        "give a number of seconds: more than 0 for a limit of time, 0 or more for any other, and at most 1e9",
    ),
    ("option-without-effect", "leave the option out, or the one that decides in its place"),
    ("paper-board-failed", "do what its cause says about the board, then run again"),
    ("pgm-header-wrong", "write the header as `P5 WIDTH HEIGHT MAXVAL`, or export the file again"),
    ("pgm-maxval-wrong", "write the file again with a maxval of 1 to 65535"),
    (
        "photograph-unreadable",
        "give --images the folder with all of Kodak's lossless pictures (https://r0k.us/graphics/kodak)",
    ),
    (
        "photographs-missing",
        "put photographs as .png files into one of the folders, or name another with --images",
    ),
    ("picture-is-no-png", "end its name in .png"),
    ("plan-not-kept", CAUSE),
    ("plan-without-mock", "write `bad` into the plan's [shift], or give --serial and --board"),
    (
        "pool-without-board",
        "see what `halfrow-station` says in the lines above, and run again when a board of this kind is free",
    ),
    (
        "pool-without-station",
        "build `halfrow-station` too (`cargo build --release --package halfrow-station`), and keep it beside this program",
    ),
    ("recording-lost", "free some space or choose another place for the recording, then run again"),
    ("report-folder-not-replaceable", "name a new folder inside it"),
    ("report-lost", "free some space or choose another place for the report, then run again"),
    (
        "request-never-answered",
        "check how the board takes in and answers that request, and whether something on the way swallows certain bytes or lengths",
    ),
    (
        "request-refused",
        "run again; if it refuses each time, correct what the board says of itself (`halfrow info`), or load another bitstream",
    ),
    ("row-factors-impossible", "give one row factor for each row, within the range that its cause names"),
    ("run-evidence-wrong", CAUSE),
    ("run-not-begun", CAUSE),
    ("run-record-wrong", CAUSE),
    (
        "run-too-long",
        "give it more with --timeout, or use a faster link; if nothing came at the end, check the board's power and the cable",
    ),
    ("secret-file-open", "run the `chmod` that the message names"),
    ("serial-port-in-use", HELD),
    (
        "serial-port-missing",
        "check that the board is plugged in and powered, and see `halfrow boards` for the ports that are there, or unplug the \
         board and plug it in if a program that used its USB chip was killed",
    ),
    ("serial-port-not-given", "let halfrow's container or service have the port, as docs/install.md says"),
    ("serial-port-not-permitted", NOT_PERMITTED),
    (
        "serial-rate-not-made",
        "give baud= a rate that the chip makes, such as those that the message names, and build the board for it",
    ),
    ("session-lost", "keep this computer and program running and the board powered, then run again"),
    ("shared-board-place-moves", "write one of the names in the message, which stay the same"),
    (
        "simulation-not-built",
        "install Verilator (`apt-get install verilator g++`), and build with Cargo's feature `sim`",
    ),
    ("sink-file-not-written", CAUSE),
    (
        "sink-folder-read-only",
        "mount it writable, or let the service write to it by `systemctl edit halfrow-station`",
    ),
    ("station-input-names-unusable", CAUSE),
    ("station-input-wrong", "do what the end of its sentence says"),
    (
        "store-of-other-user",
        "run it as the user of the station, and give that user what the message names, by the `chown` there",
    ),
    ("table-depth-unknown", "make the tables again with `halfrow tables` and --bits 8, 10 or 12"),
    (
        "table-file-is-memory-image",
        "give the table file (.json) where tables are meant, and a kernel's file or name where a kernel is",
    ),
    (
        "table-file-of-other-datapath",
        "make the tables again with `halfrow tables`, or use a halfrow that knows that datapath",
    ),
    ("table-file-wrong", "mend the file as its cause says, or make it again with `halfrow tables`"),
    ("table-key-missing", "add the key, or make the file again with `halfrow tables`"),
    ("table-list-of-wrong-length", "give WANTED entries, or make the file again with `halfrow tables`"),
    ("table-row-differs", MEND_TABLES),
    ("table-row-missing", MEND_TABLES),
    ("table-row-surplus", MEND_TABLES),
    (
        "table-value-of-wrong-kind",
        "correct the value to WANTED, or make the file again with `halfrow tables`",
    ),
    (
        "table-value-out-of-range",
        "correct the value to ALLOWED, or make the file again with `halfrow tables`",
    ),
    (
        "target-kind-unknown",
        "write one of the kinds that `halfrow help verify` names for --board; a serial port is serial:/dev/ttyUSB0",
    ),
    ("target-option-unknown", "choose from KNOWN"),
    ("target-options-wrong", CAUSE),
    ("tcp-silent", "switch that host on, or have its firewall let this port through"),
    ("usage-argument-missing", "give what the message names; `halfrow help COMMAND` shows the form"),
    ("usage-argument-unknown", "correct or leave out the argument; `halfrow help COMMAND` lists all"),
    ("usage-arguments-conflict", "keep one of the two"),
    ("usage-command-unknown", "choose a command that `halfrow help` lists"),
    ("usage-value-wrong", "give a value as the message says"),
    ("usage-wrong", "correct the call; `halfrow help COMMAND` shows its form"),
    ("usb-board-missing", "plug the board in, or name one that `halfrow boards` lists"),
    (
        "usb-channel-in-other-mode",
        "load a bitstream for the channel as it is and say its mode, or set the channel with FT_PROG or ftdi_eeprom",
    ),
    ("usb-device-failed", "unplug the board, plug it in, and run again"),
    ("usb-in-use", HELD),
    ("usb-not-given", "let halfrow's container or service have the device, as docs/install.md says"),
    ("usb-not-permitted", NOT_PERMITTED),
    (
        "usb-other-devices-only",
        "choose the board's chip by one of the targets that the message names, if it is one of them",
    ),
    (
        "usb-rate-not-made",
        "give baud= a rate that the chip makes, such as those that the message names, and build the board for it",
    ),
    ("usb-several-boards", "choose one of the targets that the message names"),
    ("waveform-not-written", "check that the folder of the waveform exists, is writable and has space"),
    ("wire-option-wrong", CAUSE),
];

/// The act for the error `code`, whose message is `sentence`: from [`ACTS`], else the message's own if it is complete.
pub(super) fn of(code: &str, sentence: &str) -> Option<String> {
    let given = ACTS.iter().find(|(known, _)| *known == code).map(|&(_, act)| act.to_owned());
    given.or_else(|| of_message(sentence))
}

/// The act at the end of a message, unless a part of it is filled in when the error happens.
fn of_message(sentence: &str) -> Option<String> {
    let (_, act) = split_remedy(sentence, &Parameters::new())?;
    (act.contains(char::is_lowercase) && !act.contains('…')).then(|| act.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::commands::explain::known::known;

    /// The only act for errors that the reader can only report; it begins with whose fault it is.
    const REPORTED: &str = "this is a fault of halfrow, so report it";

    /// The verbs with which acts begin.
    const VERBS: &str = "add allow ask build calibrate change check choose convert copy correct crop do end export free give have \
        install join keep leave let limit load look make mark mend mount name part plug put rebuild remove replay \
        record report run say scale see share start switch take test turn unplug use wait write raise move set restart \
        release restore lay publish scan stop";

    /// The codes without an act: they say how a run went, and its record has a `remedy` or nothing is to be done.
    const TOLD: &str = "board-swapped build-not-of-plan device-asked-for device-in-other-lane device-known device-new device-unsaid \
        identity-not-checked lane-armed lane-deaf lane-died lane-endless lane-idle lane-in-service lane-late lane-not-started \
        lane-put-back lane-silent lane-starts lane-stuck lane-taken-out lane-told-nonsense lane-told-to-end link-answers-wrong \
        link-tested measurement-beyond-limit measurement-missing mock-judged out-by-person plan-takes-hardware \
        result-saved-too-late run-stopped-before serial-tested serial-waits serial-waits-for-board serial-waits-instead \
        settings-without-lane-or-plan shared-board-taken shared-board-unreached station-ended step-not-reached \
        step-not-repeated-lost step-not-repeated-wrong steps-unknown";

    /// Whether an act tells its reader what to do.
    fn is_act(act: &str) -> bool {
        let first = act.split([' ', ',']).next().unwrap_or_default();
        act == REPORTED || VERBS.split(' ').any(|verb| verb == first)
    }

    #[test]
    fn every_error_has_an_act_that_begins_with_a_verb() {
        let errors: Vec<_> = known().into_values().flatten().filter(|it| it.of == "error").collect();
        assert!(errors.len() > 300, "{}", errors.len());
        let without: Vec<_> = errors
            .iter()
            .filter(|it| it.acts.is_empty() || !it.acts.iter().all(|act| is_act(act) && !act.contains('…')))
            .map(|it| (&it.code, &it.acts))
            .collect();
        assert!(without.is_empty(), "give these an act in ACTS: {without:#?}");
    }

    #[test]
    fn every_error_of_the_station_has_an_act_but_what_tells_how_a_run_went() {
        let all = known().into_values().flatten().filter(|it| it.of == "station-error");
        let without = all.filter(|it| it.acts.iter().all(|act| act.contains('…'))).map(|it| it.code);
        let without: Vec<_> = without.collect();
        assert_eq!(without.join(" "), TOLD, "give those that TOLD does not name an act in ACTS");
    }

    #[test]
    fn a_message_of_an_error_asks_once() {
        let is_error = |of: &str| ["error", "station-error"].contains(&of);
        for it in known().into_values().flatten().filter(|it| is_error(it.of)) {
            let message = if it.sentence.is_empty() { &it.meaning } else { &it.sentence };
            // The rows of a matrix are in brackets, with semicolons of their own.
            let outside = message.split(['[', ']']).step_by(2);
            let asked: usize = outside.map(|part| part.matches("; ").count()).sum();
            // The remedy is what follows the last semicolon: of two remedies, the first would be lost.
            assert!(asked < 2, "{}: {message}", it.code);
        }
    }

    #[test]
    fn acts_stand_in_the_order_of_their_codes_and_no_message_has_its_own_beside_them() {
        assert!(ACTS.is_sorted_by(|one, other| one.0 < other.0));
        let is_error = |of: &str| ["error", "station-error"].contains(&of);
        let errors: Vec<_> = known().into_values().flatten().filter(|it| is_error(it.of)).collect();
        for (code, act) in ACTS {
            let it = errors.iter().find(|it| it.code == *code);
            let own = it.map_or_else(|| panic!("no error {code}"), |it| of_message(&it.sentence));
            assert!(!own.as_deref().is_some_and(is_act), "{code}: {own:?} and {act}");
        }
    }
}
