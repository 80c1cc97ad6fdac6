//! The codes of errors of boards, links and targets.

use halfrow_protocol::message::{Malformed, UnknownDatapath};

use super::codes;
use crate::board::BoardError;
use crate::correction::CorrectionError;
use crate::coverage::FaultsError;
use crate::link::{
    LinkError, OpenError, RecordingError, SerialError, TcpError, TraceError, UsbError, UsbFailure,
};
use crate::link_test::LinkTestError;
use crate::run::{
    CannotJudge, GoldenError, Misfit, NoThread, NotAllJudged, PlanLengthError, PrepareError, RestoreError,
    WithinError,
};
use crate::target::TargetError;

codes! {
    BoardError {
        Link [doing] => "link-broke",
        NoAnswer [kind, attempts, waited] => "no-answer",
        Unanswered [kind, bytes, attempts] => "request-never-answered",
        DamagedEachTime [kind, bytes, attempts] => "request-damaged-each-time",
        Unclosed => "packets-unclosed",
        NotABoard => "not-a-board",
        Echoed => "line-echoes",
        Impossible [capability, value, legal] => "capability-out-of-range",
        Console [bytes] => "console-answers",
        Version [board, ours] => "wire-version-unknown",
        Held [seconds] => "board-held",
        NotGivenUp [seconds] => "take-over-refused",
        SessionLost [silent] => "session-lost",
        Refused [kind, refusal] => "request-refused",
        Malformed [kind] => "answer-malformed",
        Unexpected [kind] => "answer-of-other-kind",
        OtherBurst [again] => "burst-begun-again",
        TooPoor [retries, packets, limit] => "link-too-poor",
        RowMissing [place, attempts] => "row-missing",
        WrongPlace [place] => "row-place-unknown",
        Timeout [limit, silent] => "run-too-long",
        Stopped (by) => "stopped-by-signal",
        = TurnedAway,
    }
    LinkError {
        Closed [link, at] => "link-closed",
        ClosedAfar [link, at] => "connection-closed",
        Stopped [board, at] => "board-process-stopped",
        Unplugged [link, at] => "board-unplugged",
        InUse [link, text] => "link-in-use",
        NoBoardThere [link, text] => "link-without-board",
        Failed [link, at] => "link-failed",
        OtherConversation [byte] => "recording-of-other-run",
        RecordingEnds [link, at] => "recording-ends",
        Record => "recording-not-written",
        = Trace,
    }
    OpenError {
        UnknownKind [kind] => "target-kind-unknown",
        NoAddress [kind, address] => "target-takes-no-address",
        AddressMissing [kind, form] => "target-address-missing",
        Option [kind, option, known] => "target-option-unknown",
        OtherBoard [option, board, meaning] => "target-option-contradicts-board",
        Options [board, target] => "target-options-wrong",
        Pace [key, value] => "target-pace-wrong",
        UnknownFront (front) => "simulation-unknown",
        NoSimulation (target) => "simulation-not-built",
        System [target] => "target-not-let-be-used",
        = Serial,
        = Tcp,
        = Usb,
        = Recording,
        = Trace,
    }
    TargetError {
        Empty => "target-empty",
        Option [option, target] => "target-option-malformed",
    }
    SerialError {
        Missing (path) => "serial-port-missing",
        NotAPort (path) => "serial-port-is-none",
        NotAllowed [path, remedy] => "serial-port-not-permitted",
        NotGiven (path) => "serial-port-not-given",
        InUse [path, holders] => "serial-port-in-use",
        Rate [path, chip, baud, nearest] => "serial-rate-not-made",
        OtherRate [path, baud, taken] => "serial-rate-not-taken",
        Other [path] => "serial-port-not-opened",
    }
    TcpError {
        Address (address) => "tcp-address-malformed",
        UnknownHost [address] => "tcp-host-unknown",
        Refused (address) => "tcp-refused",
        Silent [address, seconds] => "tcp-silent",
        Unreachable [address] => "tcp-unreachable",
    }
    UsbError {
        NoUsb => "usb-not-there",
        NoneFound => "usb-no-board",
        OthersOnly (found) => "usb-other-devices-only",
        NotFound [wanted, found] => "usb-board-missing",
        Several (found) => "usb-several-boards",
        NoChannel [chip, name, channel, channels] => "usb-channel-missing",
        NotPermitted [name, remedy] => "usb-not-permitted",
        NotGiven [name] => "usb-not-given",
        Busy [what, holders] => "usb-in-use",
        OtherMode [name, channel, found, wanted] => "usb-channel-in-other-mode",
        UnusableMode [name, channel, found] => "usb-channel-mode-unusable",
        NoFifo [chip, name] => "usb-chip-without-fifo",
        NoMode [name, channel, found] => "usb-channel-mode-unknown",
        BaudOfFifo => "usb-fifo-has-no-rate",
        Rate [chip, baud, nearest] => "usb-rate-not-made",
        Transfer [name, doing] => "usb-transfer-failed",
        NoThread [name] => "usb-thread-missing",
    }
    RecordingError {
        Read [path] => "recording-unreadable",
        Foreign (path) => "recording-is-none",
        Head [path] => "recording-head-damaged",
        = NotRegular,
        = Create,
    }
    RestoreError {
        Tables => "recorded-tables-wrong",
        Value => "recorded-run-impossible",
        Frame [name] => "recorded-frame-wrong",
        = Recording,
    }
    LinkTestError {
        BrokeOff [wrong] => "link-test-broke-off",
        PoorLink [errors] => "link-test-on-poor-link",
        NoFrame => "link-test-frame-not-made",
        = Board,
    }
    PrepareError {
        Render [name] => "frame-not-made",
        Correct [name] => "frame-not-corrected",
    }
    Misfit {
        Datapath => "board-of-other-datapath",
        Size [width, height, most_width, most_height] => "frames-too-large-for-board",
        Depth [bits, taken] => "depth-not-of-board",
        NoGrids => "board-without-grids",
        GridEntries [entries, most] => "grid-too-large-for-board",
        GridPitch [pitch, taken] => "grid-of-other-pitch",
        Taps => "kernel-has-too-many-taps",
        Frame [name] => "frame-unfit",
        CentreRow => "centre-row-not-finite",
        = Ring,
        = Length,
        = Within,
    }
    PlanLengthError {
        NoFrames => "plan-without-frames",
        TooManyFrames [frames] => "too-many-frames",
    }
    WithinError {
        TooFew [seconds, least] => "seconds-too-few-for-verdict",
        TooFewOfClock [seconds, least, clock_hz] => "seconds-too-few-for-named-clock",
        AtSpeed [seconds, least] => "seconds-too-few-at-speed",
        = Faults,
    }
    FaultsError {
        Form [what] => "fault-table-unreadable",
        Fault [fault, what] => "fault-table-wrong",
    }
    CorrectionError {
        = Misfit,
        = Frame,
        = Board,
    }
    GoldenError {
        Unmade [what] => "golden-values-not-made",
        Frame [interpolant, expected, found] => "golden-frame-wrong",
        Row [interpolant, column, expected, found] => "golden-row-wrong",
        Unseen [interpolant] => "golden-error-unseen",
        = Correct,
    }
    ;
    CannotJudge => "computer-cannot-judge"
    ;
    NotAllJudged [planned, judged] => "samples-not-judged"
    ;
    NoThread => "run-thread-missing"
    ;
    UsbFailure => "usb-device-failed"
    ;
    TraceError => "waveform-not-written"
    ;
    UnknownDatapath [id] => "datapath-not-known"
    ;
    Malformed => "message-malformed"
}
