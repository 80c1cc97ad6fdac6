//! Boards with wrong names.

use halfrow_tests::program::Folder;

use crate::refused;

#[track_caller]
fn no_such_board(target: &str, sentence: &str) {
    let folder = Folder::new();
    refused(&folder, &["verify", "--board", target], sentence);
    refused(&folder, &["info", "--board", target], sentence);
}

/// Whatever is plugged in.
#[test]
fn a_path_that_leads_nowhere_is_no_port() {
    let folder = Folder::new();
    folder.write("file", "");
    std::os::unix::fs::symlink("loop", folder.path().join("loop")).unwrap();
    for path in ["loop", "file/x"] {
        let said = format!("{path} is no serial port; see `halfrow boards`");
        refused(&folder, &["info", "--board", &format!("serial:{path}")], &said);
    }
}

/// The cost of a run is listed without opening its board, but not for a target that is none.
#[test]
fn a_list_for_a_board_that_cannot_be_named_is_refused() {
    let folder = Folder::new();
    for (target, sentence) in [
        ("serial:/dev/x,baud=abc", "`baud=abc` is not an option of `serial`"),
        ("serial", "write serial:PATH"),
        ("usb,foo=1", "`foo=1` is not an option of `usb`"),
        ("usb:", "write usb or usb:SERIAL"),
        ("usb:,mode=fifo", "write usb or usb:SERIAL"),
        ("tcp:nope", "`nope` is no host and port"),
    ] {
        refused(&folder, &["verify", "--list", "--board", target], sentence);
    }
    folder.halfrow(["verify", "--list", "--board", "serial:/dev/x,baud=9600"]).succeeded();
}

#[test]
fn an_unknown_kind_is_refused() {
    no_such_board("moon", "`moon` is not a known kind of board");
    no_such_board(
        "/dev/ttyUSB0",
        "`/dev/ttyUSB0` is not a known kind of board; for a serial port write serial:/dev/ttyUSB0",
    );
    no_such_board("ttyUSB0", "for a serial port write serial:/dev/ttyUSB0");
    no_such_board("mokc", "(did you mean mock?); choose from mock, sim");
    // A recording is judged again by `verify` alone, and a pool's board is borrowed by whoever asks a board something.
    let folder = Folder::new();
    for (call, ending) in [
        (&["verify", "--board", "moon"][..], "tcp:HOST:PORT, replay:FILE, or pool:KIND\n"),
        (&["info", "--board", "moon"], "tcp:HOST:PORT, or pool:KIND\n"),
        (&["soak", "--frames", "1", "--board", "moon"], "tcp:HOST:PORT, or pool:KIND\n"),
        (&["correct", "builtin:black", "-o", "x.pgm", "--board", "moon"], "tcp:HOST:PORT, or pool:KIND\n"),
        (&["boards", "moon"], "tcp:HOST:PORT\n"),
        (&["serve", "--board", "moon"], "tcp:HOST:PORT\n"),
    ] {
        refused(&folder, call, ending);
    }
    no_such_board("Mock", "(did you mean mock?); choose from mock, sim");
    no_such_board("", "names no board");
    no_such_board("mock:7", "`mock` takes no address");
    no_such_board("mock,latency", "write KEY=VALUE");
    no_such_board("mock,=3", "write KEY=VALUE");
}

#[test]
fn an_unknown_option_of_the_mock_is_refused_with_those_that_there_are() {
    no_such_board(
        "mock,colour=red",
        "`colour` is not an option of this board; choose from pace, latency, ring",
    );
    no_such_board("mock,latenc=12", "(did you mean latency?); choose from pace, latency, ring");
    no_such_board("mock,bit=3", "a fault's parameters need fault=NAME");
    no_such_board("mock,latency=12,latency=13", "latency is given twice");
    no_such_board("mock,pace=fast", "pace=virtual or pace=real");
    no_such_board("mock,pace=real,pace=virtual", "pace is given twice");
}

#[test]
fn a_build_that_cannot_exist_is_refused() {
    no_such_board("mock,latency=33", "latency=33 is out of range; give a number from 4 to 32");
    no_such_board("mock,latency=soon", "latency=soon is not a whole number");
    no_such_board("mock,ring=100", "ring=100 is not a power of two");
    no_such_board("mock,ring=64,max-width=128", "ring=64 is shorter than a row of max-width=128");
    no_such_board("mock,max-width=65", "max-width=65 is odd");
    no_such_board("mock,taps=six", "taps=six is not known; give one of five, seven");
    no_such_board("mock,depths=9", "depths=9 is not known");
    no_such_board("mock,speed=0", "speed=0 is out of range");
    no_such_board("mock,delay=-1", "delay=-1 is not a number from 0 to 60");
}

#[test]
fn a_fault_that_does_not_exist_is_refused() {
    no_such_board("mock,fault=moon", "no fault of this board is called `moon`; choose from flip, drop");
    no_such_board("mock, fault=stuk-data", "called `stuk-data` (did you mean stuck-data?); choose from flip");
    no_such_board(
        "mock,fault=late,fault=no-rounding",
        "fault=late and fault=no-rounding cannot be had together",
    );
    no_such_board("mock,fault=late,bit=1", "`bit` is not an option");
    no_such_board("mock,fault=stuck-data,bit=12", "bit=12 is out of range; give a number from 0 to 11");
    no_such_board(
        "mock,fault=kernel-word,weight=g2",
        "weight=g2 is not known; give one of g0, r1, g4, r5, g6",
    );
    no_such_board("mock,fault=flip,rate=2", "rate=2 is not a number from 0 to 1");
    no_such_board("mock,fault=flip,rate=1e-3,byte=1", "both say where the fault strikes");
    no_such_board("mock,fault=reorder,byte=3", "`byte` is not an option");
}
