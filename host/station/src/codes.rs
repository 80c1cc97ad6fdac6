//! The codes of the station's own errors.

use std::error::Error;

use halfrow::result::Problem;
use halfrow::result::codes::{self, CodeList, Coded};
use halfrow_program::codes as program;
use serde_json::Value;

use crate::commands::refusals;
use crate::disk::DiskError;
use crate::engine::HookError;
use crate::exit::Exit;
use crate::export::ExportError;
use crate::floor::{Refusal, ScanError, UnknownBarcode};
use crate::ids::NoRandomness;
use crate::input_error::InputError;
use crate::kept::CopyError;
use crate::labgrid::LabgridError;
use crate::outbox::{OutboxError, SinkError, SinkSettingsError};
use crate::plan::serial::SerialError;
use crate::published::{BundleError, FetchError, SigningError};
use crate::record::{BlobError, RecordError};
use crate::run::RunError;
use crate::said::Saying;
use crate::secret::SecretError;
use crate::settings::PlantSettingsError;
use crate::store::{
    AgainError, NoWaiver, PlantAddressError, PlantError, ReasonError, RebindError, StoreError,
};
use crate::trust::{CertificateError, TrustError};
use crate::work::{Lost, WorkError};

codes::codes! {
    InputError {
        Unreadable [path] => "station-input-unreadable",
        NotText [path] => "station-input-no-text",
        Path [path] => "station-input-path-no-text",
        Wrong [path, line, what] => "station-input-wrong",
        Input [path, line, what] => "station-input-names-unusable",
    }
    SerialError {
        Empty => "serial-empty",
        TooLong [characters] => "serial-too-long",
        Character [character, place] => "serial-character-wrong",
        Reserved [serial] => "serial-reserved",
        Blank [serial] => "serial-with-blank",
        Pattern [serial, pattern] => "serial-of-no-product",
        CheckDigit [serial] => "serial-check-digit-wrong",
    }
    ScanError {
        Incomplete => "scan-incomplete",
        Late => "scan-late",
        NoLane [lane, known] => "lane-unknown",
        WhichLane [lanes] => "lane-not-named",
        ChoiceOver [lane, seconds] => "lane-choice-over",
        Together [lanes] => "boards-came-together",
        Ambiguous [serial, first, second] => "serial-of-two-products",
        Elsewhere [serial, lane] => "serial-in-other-lane",
        = Barcode,
        = Serial,
        = Lane,
    }
    Refusal {
        Out [lane, why] => "lane-out",
        Owes [lane, why] => "lane-not-checked",
        NoMock [lane] => "lane-owes-no-mock",
        Busy [lane, serial] => "lane-busy",
        Unsaved [lane, serial] => "lane-unsaved",
        NoBoard [lane] => "lane-empty",
        NoSerial [lane] => "lane-without-serial",
        NoButton [lane] => "lane-without-button",
        NothingToAbort [lane] => "lane-idle",
        InService [lane] => "lane-in-service",
    }
    RunError {
        NotBegun => "run-not-begun",
        Unsaved [run] => "run-unsaved",
        = PlanFile,
        = Serial,
        = NoRandomness,
    }
    StoreError {
        InUse [folder] => "store-in-use",
        Folder [folder] => "store-folder-unusable",
        OtherUser [path, owner, user, folder] => "store-of-other-user",
        Path [folder] => "store-path-no-text",
        NoResults [folder] => "store-without-results",
        DatabaseGone [folder] => "store-without-database",
        Unrestored [folder] => "store-restore-unfinished",
        Database [path, doing] => "database-refuses",
        Locked [path, doing] => "database-locked",
        Damaged [path] => "database-unreadable",
        Replaced [path] => "database-replaced",
        LockReplaced [path] => "store-lock-replaced",
        OtherLog [path] => "database-beside-other-log",
        ReadOnlyLog [path] => "database-log-read-only",
        Unfinished [path] => "database-unfinished",
        NoRoom [path, megabytes] => "database-without-room",
        Plant [plant, doing] => "plant-refuses",
        NoRecord [plant, sha256] => "plant-without-record",
        NoLog [path, mode] => "database-without-log",
        Newer [path, found, known] => "database-newer",
        Older [path, found, known] => "database-older",
        OtherSchema [path, version] => "database-of-other-schema",
        ClockApart [minutes] => "clocks-apart",
        DatedAhead [minutes] => "last-run-dated-ahead",
        BeingJudged [serial, lane] => "unit-being-judged",
        NotOpen [run] => "run-not-open",
        UnknownProcess [spool, process] => "lane-process-unknown",
        ReadsOtherwise [run] => "run-reads-otherwise",
        = Certificate,
        = Blob,
        = Record,
        = NoRandomness,
    }
    PlantError {
        OtherContent [run, ours, theirs] => "plant-has-other-record",
        NotYet [run] => "plant-without-run",
        Lost [run] => "plant-lost-run",
        NotKept [subject] => "plant-kept-nothing",
        OtherStation [name] => "plant-has-other-station",
        Collation [plant, collation, encoding] => "plant-of-other-collation",
        = Store,
    }
    PlantAddressError {
        Malformed => "plant-address-malformed",
        Without [what] => "plant-address-incomplete",
        Password => "plant-address-with-password",
        = Trust,
    }
    TrustError {
        Certificates [path] => "certificates-unreadable",
        NoCertificates => "certificates-missing",
        Tls => "tls-unusable",
    }
    CertificateError {
        Expired [host, until, now] => "certificate-expired",
        NotYet [host, from, now] => "certificate-not-valid-yet",
        OtherName [host, names] => "certificate-of-other-name",
        Stranger [host] => "certificate-of-stranger",
        Unfit [host] => "certificate-unfit",
    }
    OutboxError {
        Thread => "outbox-without-thread",
        = Store,
    }
    SinkSettingsError {
        Token [path] => "sink-token-malformed",
        = Secret,
        = Trust,
    }
    SinkError {
        NoFolder [path] => "sink-without-folder",
        Shut [path] => "sink-folder-shut",
        ReadOnly [path] => "sink-folder-read-only",
        OtherFile [path] => "sink-has-other-file",
        Unread [path] => "sink-file-unreadable",
        Unreached [host] => "sink-unreached",
        Busy [host, status] => "sink-busy",
        Closed [host, status] => "sink-closed",
        Unknown [host, said] => "sink-knows-no-user",
        Rejected [host, status, answer] => "sink-rejects",
        Dropped [host, bytes] => "sink-ends-connection",
        Unconfirmed [host, seconds] => "sink-unconfirmed",
        Unwritten => "sink-file-not-written",
        = Certificate,
        = Export,
    }
    WorkError {
        NoPlan [job, sha256] => "job-without-plan",
        Target [board, target] => "shared-board-without-place",
        Serial [board, serial, plan] => "shared-board-of-no-serial",
        NotTaken [run, said] => "job-run-not-taken",
        = Run,
        = Again,
    }
    Lost {
        Taken [board] => "shared-board-taken",
        Unreached [board, seconds, said] => "shared-board-unreached",
    }
    LabgridError {
        NotStarted [program] => "labgrid-program-not-started",
        Failed [program, said] => "labgrid-program-failed",
        Late [place, seconds] => "labgrid-late",
        CoordinatorAway [coordinator] => "labgrid-coordinator-away",
        Unknown [place, known] => "labgrid-place-unknown",
        Held [place, holder] => "labgrid-place-held",
        NotAcquired [place, said] => "labgrid-place-not-given",
        NotReleased [place] => "labgrid-place-not-taken-back",
        Lost [place, status] => "labgrid-place-lost",
        NoPort [place] => "labgrid-place-without-port",
        SeveralPorts [place, ports] => "labgrid-place-with-several-ports",
        PortAway [place] => "labgrid-port-away",
        Protocol [place, protocol] => "labgrid-port-not-raw",
    }
    SigningError {
        File [path] => "plan-key-not-made",
        NoKey [path] => "plan-key-malformed",
        NoRandomness => "plan-key-without-randomness",
        NoPublicKey [text] => "plan-public-key-malformed",
        = Secret,
    }
    BundleError {
        Outside [name] => "plan-file-outside",
        Plan => "plan-file-named-as-plan",
        Control [name] => "plan-file-name-unplain",
        TooLarge [bytes] => "plan-files-too-large",
        Changed [path] => "plan-file-changed",
        Malformed [sha256] => "published-plan-malformed",
        Damaged [sha256, found] => "published-plan-damaged",
        Folder [path] => "plan-folder-unusable",
        Uncopied [path] => "plan-not-copied",
        Unwritten => "plan-not-kept",
    }
    FetchError {
        None [plan] => "plan-not-published",
        Untrusted [plan] => "published-plan-untrusted",
        Older [plan, number, kept] => "published-plan-older",
        Plan [plan] => "published-plan-unusable",
        = Store,
        = Bundle,
    }
    PlantSettingsError {
        = Address,
        = Secret,
    }
    SecretError {
        File [path] => "secret-file-unusable",
        Folder [path] => "secret-file-is-folder",
        Open [path] => "secret-file-open",
        GivenOpen [path] => "given-secret-open",
        Empty [path] => "given-secret-empty",
        Wrong [path, what] => "secret-file-wrong",
        NoRandomness => "secret-without-randomness",
    }
    BlobError {
        Folder [path] => "evidence-folder-unusable",
        Write => "evidence-not-written",
        Read [path] => "evidence-unreadable",
        Damaged [path, found] => "evidence-damaged",
    }
    AgainError {
        Refused [serial, when] => "unit-passed-already",
        Asked [serial, when] => "unit-passed-already-asks",
        NotAtPlant [serial, when] => "unit-passed-not-at-plant",
    }
    DiskError {
        Refused [folder, what] => "disk-refused",
        Untold [folder] => "disk-unknown",
    }
    RecordError {
        NotANumber [name, value] => "record-without-number",
        Incomplete [seq, steps] => "record-incomplete",
        OtherSchema [schema] => "record-of-other-schema",
        Json => "record-unreadable",
    }
    ReasonError {
        Missing => "reason-missing",
        TooLong [characters, most] => "reason-too-long",
    }
    RebindError {
        Unknown [serial] => "unit-unknown",
        Several [serial, first, second] => "unit-of-two-products",
        NoDevice [device] => "device-malformed",
        UnderTest [serial] => "unit-under-test",
        = Store,
    }
    NoWaiver {
        NoRun [run] => "waiver-without-run",
        NoFail [run, verdict] => "waiver-without-fail",
        Waived [run] => "waiver-given-already",
        = NoRandomness,
        = Store,
    }
    CopyError {
        Exists [path] => "copy-would-overwrite",
        UnderWay [path] => "copy-of-runs-under-way",
        Inside [path] => "copy-in-itself",
        Io [path] => "copy-not-written",
        Faulty [path, faults, first] => "copy-faulty",
        = Plans,
        = Store,
    }
    ExportError {
        Xml => "export-not-encoded-as-xml",
        Json => "export-not-encoded-as-json",
        Write => "export-not-written",
        = Store,
    }
    HookError {
        Start [program] => "hook-not-started",
        Failed [program, status, said] => "hook-failed",
        Late [program, deadline] => "hook-late",
    }
    Saying {
        Armed [lane] => "lane-armed",
        Starts [lane] => "lane-starts",
        ToldToEnd [lane] => "lane-told-to-end",
        Forgotten [lane, serial] => "serial-forgotten",
        TakenOut [lane] => "lane-taken-out",
        PutBack [lane] => "lane-put-back",
        Tested [serial, lane] => "serial-tested",
        MockJudged [lane] => "mock-judged",
        Waits [serial, lane] => "serial-waits",
        WaitsForPlug [serial] => "serial-waits-for-board",
        WaitsInstead [serial, other] => "serial-waits-instead",
        NotGiven [serial, why] => "serial-not-given",
        OutByPerson => "out-by-person",
        Unkillable => "out-by-process",
        GoodUnitWrong [serial, verdict] => "shift-good-unit-wrong",
        BadUnitWrong [serial, verdict] => "shift-bad-unit-wrong",
        GoodUnitDue [serial] => "shift-good-unit-due",
        BadUnitDue [serial] => "shift-bad-unit-due",
        MockDue [barcode] => "shift-mock-due",
        MockWrong [target, verdict, barcode] => "shift-mock-wrong",
        NoLaneOrPlan => "settings-without-lane-or-plan",
        NoThread [error] => "thread-missing",
        HooksBehind [verdicts] => "hooks-behind",
        HardwareAlone [kind] => "plan-takes-hardware",
        BuildNotOfPlan [build, builds] => "build-not-of-plan",
        DeviceAskedFor => "device-asked-for",
        DeviceUnsaid => "device-unsaid",
        IdentityUnchecked [name, kind, build] => "identity-not-checked",
        DeviceKnown [name, kind, build, device] => "device-known",
        DeviceNew [name, kind, build, device] => "device-new",
        StoppedBefore => "run-stopped-before",
        StillHeld [seconds] => "board-still-held",
        NotRepeatedWrong => "step-not-repeated-wrong",
        NotRepeatedLost => "step-not-repeated-lost",
        LinkTested [link] => "link-tested",
        LinkAnswersWrong [wrong] => "link-answers-wrong",
        BoardSwapped [first, now] => "board-swapped",
        DeviceElsewhere [device] => "device-in-other-lane",
        OtherProduct [serial, product, scanned] => "board-of-other-product",
        OtherSerial [serial, scanned] => "board-of-other-serial",
        OtherDevice [serial, device, found] => "serial-of-other-device",
        BeyondLimit [name, value, unit, low, high] => "measurement-beyond-limit",
        NotMeasured [name, unit, low, high] => "measurement-missing",
        StepsUnknown [passed, planned] => "steps-unknown",
        StepNotReached => "step-not-reached",
        LaneBabbles [line] => "lane-told-nonsense",
        LaneOfOtherProgram [program] => "lane-of-other-program",
        LaneDied [status] => "lane-died",
        LaneNotStarted [error] => "lane-not-started",
        LaneSilent [seconds] => "lane-silent",
        LaneLate [seconds] => "lane-late",
        LaneDeaf [seconds] => "lane-deaf",
        LaneStuck [why] => "lane-stuck",
        LaneEndless => "lane-endless",
        PlanChanged => "plan-changed",
        PlanFileOther [file] => "plan-file-other",
        StationEnded [tries] => "station-ended",
        SavedTooLate [tries] => "result-saved-too-late",
        NotAtPlant => "result-not-at-plant",
        TooMuchUnsent [entries, most] => "outbox-too-full",
        DiskTooFull [percent] => "disk-too-full",
    }
    ;
    UnknownBarcode [text] => "barcode-unknown"
    ;
    NoRandomness => "no-randomness"
}

/// The code of an error of the station, of the library or of the system.
pub(crate) fn known(error: &(dyn Error + 'static)) -> Option<Coded> {
    lookup(error).or_else(|| refusals::lookup(error)).or_else(|| program::known(error))
}

/// Why a command has no result.
pub(crate) fn problem(exit: Exit, error: &anyhow::Error) -> Problem {
    program::problem(exit, error, known)
}

/// Every list of the station's own codes.
pub(crate) fn lists() -> impl Iterator<Item = &'static CodeList> {
    LISTS.iter().chain(refusals::LISTS).filter(|list| !list.codes.is_empty())
}

/// Every code that a document of the station can have.
pub(crate) fn all() -> Vec<Value> {
    let library = codes::LISTS.into_iter().flatten().chain(program::lists());
    let typed = lists().chain(library).flat_map(|list| list.codes).map(|(code, _)| *code);
    let others = codes::io_codes().into_iter().chain(program::USAGE).chain(program::UNTYPED);
    typed.chain(others).map(Value::from).collect()
}
