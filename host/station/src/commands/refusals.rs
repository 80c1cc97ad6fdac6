//! The codes of what commands refuse, whatever the cause, and of what checks find.

use halfrow::result::codes;

use super::beginning::NoPlant;
use super::board::{NoBoard, NoBoardKind, NoKind, OtherPlace, SharedAlready};
use super::evidence::{EvidenceLost, EvidenceRemoved, NoSuchRun};
use super::export::{NoFolder, RunsLost, Taken};
use super::job::{NoJob, NoWord};
use super::looking::NoRange;
use super::outbox::{NoSink, NotDead, SinkInUse, SinkUnknown};
use super::plant::NoStation;
use super::publish::PublishError;
use super::run::{NoMock, NotLetGo};
use super::token::NoTokens;
use super::unit::NoSuchUnit;
use super::user::NoUsers;
use super::work::NoWork;
use crate::check::{Fault, Superseded};
use crate::engine::EngineEnded;
use crate::outbox::SendingEnded;
use crate::web::PagesEnded;

codes::codes! {
    PublishError {
        OtherContent [plan, version] => "plan-version-taken",
        TooLate [plan] => "plan-published-meanwhile",
        NoVersion [plan, version] => "plan-version-unknown",
        Untrusted [plan] => "plan-statement-untrusted",
        NoNumber [plan] => "plan-without-number",
        Slash [product] => "plan-product-with-slash",
    }
    OtherPlace {
        Moves [what] => "shared-board-place-moves",
        Local [board] => "shared-board-at-every-station",
    }
    Fault {
        Database [said] => "database-damaged",
        Evidence [run] => "run-evidence-wrong",
        Record [run] => "run-record-wrong",
        Contradiction [run] => "run-contradicts",
        Unkept [run, sha256] => "run-record-not-kept",
        Unnamed [run, sha256] => "run-without-row",
        Foreign [path] => "kept-plans-foreign",
        Job [job] => "job-without-run",
        Audit [id] => "audit-contradicts",
        Waiver [run] => "waiver-contradicts",
        Plan [run] => "run-plan-wrong",
        Differs [table, key, column, stored, rebuilt] => "table-row-differs",
        Missing [table, key] => "table-row-missing",
        Surplus [table, key] => "table-row-surplus",
        = Piece,
    }
    ;
    Superseded [run, row, sha256, verdict] => "run-record-superseded"
    ;
    EngineEnded => "engine-ended"
    ;
    PagesEnded => "pages-ended"
    ;
    SendingEnded => "sending-ended"
    ;
    NoMock => "plan-without-mock"
    ;
    NotLetGo [lane] => "board-not-let-go"
    ;
    NoRange => "range-without-moment"
    ;
    NoPlant => "settings-without-plant"
    ;
    NotDead [what] => "outbox-entry-not-dead"
    ;
    NoSink => "settings-without-sink"
    ;
    NoUsers => "settings-without-users"
    ;
    NoTokens => "settings-without-tokens"
    ;
    NoWork => "settings-without-work"
    ;
    NoJob [id] => "job-not-changed"
    ;
    NoWord [word] => "job-needs-no-word"
    ;
    NoBoardKind [kind] => "shared-board-of-unknown-kind"
    ;
    SharedAlready [serial, board] => "shared-board-of-shared-unit"
    ;
    NoBoard [name] => "shared-board-not-changed"
    ;
    NoKind [kind] => "shared-board-of-no-kind"
    ;
    SinkInUse [sink] => "sink-in-use"
    ;
    SinkUnknown [sink] => "sink-unknown"
    ;
    NoStation [station] => "plant-without-station"
    ;
    NoSuchRun [run] => "run-unknown"
    ;
    NoSuchUnit [serial] => "unit-never-tested"
    ;
    EvidenceLost [names, run] => "evidence-lost"
    ;
    EvidenceRemoved [names, run] => "evidence-removed"
    ;
    RunsLost [runs] => "export-incomplete"
    ;
    NoFolder [path] => "output-folder-unusable"
    ;
    Taken [path] => "output-taken"
}
