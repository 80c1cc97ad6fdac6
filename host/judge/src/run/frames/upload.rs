//! Geometry and tables on their way to the board, and back through the datapath's own ports.

use crate::board::{Bank, BoardError, ReadBack, RefusalCode, RowTiming, Table};
use crate::diagnosis;
use crate::result::{CheckName, Finding, Suspect};
use crate::run::findings::{During, End};
use crate::run::plan::{SENSOR_BLANKING, Segment, Timing};
use crate::run::steps::Run;
use crate::tables::{Generation, datapath_of};

impl Run<'_> {
    /// Sets up the board for a segment, tables included.
    pub(crate) fn prepare(&mut self, segment: &Segment) -> Result<(), End> {
        self.configure(segment)?;
        let rows = segment.geometry.height();
        segment.commit.map_or(Ok(()), |(number, first_frame)| self.commit(number, first_frame, rows))
    }

    pub(crate) fn configure(&mut self, segment: &Segment) -> Result<(), End> {
        let timing = match segment.timing {
            Timing::Least => RowTiming::default(),
            Timing::Sensor => RowTiming { blanking: SENSOR_BLANKING, ..RowTiming::default() },
            Timing::Gaps(gap_seed) => RowTiming { gap_seed, ..RowTiming::default() },
        };
        // All tables of a plan are of one kind.
        let datapath = datapath_of(&self.plan.tables);
        self.board.configure(&segment.geometry, timing, datapath).during(CheckName::Upload)
    }

    /// Uploads and commits a generation, to be used from `first_frame` on, for frames of `rows` rows.
    pub(crate) fn commit(&mut self, number: u8, first_frame: u16, rows: usize) -> Result<(), End> {
        let generation = self.generation(number);
        generation.map_or(Ok(()), |generation| self.upload(&generation, first_frame, rows))
    }

    /// Uploads whole tables, whatever part of them the frames use, because frames at speed are whole.
    fn upload(&mut self, generation: &Generation, first_frame: u16, rows: usize) -> Result<(), End> {
        let Generation { number, tables, kernel } = generation;
        self.board.upload(tables, kernel).during(CheckName::Upload)?;
        let (entries, nodes) = (tables.entries().len(), kernel.nodes().len());
        let uploaded = Finding::TablesUploaded { entries, nodes, generation: *number };
        self.findings.checks.passed(CheckName::Upload, uploaded);
        let ports = self.check_read_back(CheckName::ReadBack, Bank::Shadow, generation)?;
        self.commit_uploaded(generation, first_frame, rows).map_err(|error| match error {
            BoardError::Refused { refusal, .. } if refusal.code == RefusalCode::TableCrc => {
                End::failed(CheckName::ReadBack, Finding::CommitCrcWrong {})
            }
            error => End::board(CheckName::Upload, &error),
        })?;
        self.findings.checks.passed(CheckName::ReadBack, Finding::TablesReadBack { ports });
        Ok(())
    }

    /// Commits a generation whose tables the board has, to be used from `first_frame` on, for frames of `rows` rows.
    pub(super) fn commit_uploaded(
        &mut self,
        generation: &Generation,
        first_frame: u16,
        rows: usize,
    ) -> Result<(), BoardError> {
        let Generation { number, tables, kernel } = generation;
        let upper = generation.upper(rows);
        let committed = upper.as_ref().map_or(tables, |upper| &upper.tables);
        self.board.commit(committed, kernel, first_frame, *number)
    }

    /// Compares the CRCs of both tables through every port, and returns the number of ports. A table with another CRC is
    /// read entry by entry, to find which one is wrong.
    pub(crate) fn check_read_back(
        &mut self,
        check: CheckName,
        bank: Bank,
        generation: &Generation,
    ) -> Result<usize, End> {
        let Generation { tables, kernel, .. } = generation;
        let read = self.board.read_back(bank, tables, kernel).during(check)?;
        match read.iter().find(|read| !read.agrees()) {
            None => Ok(read.len()),
            Some(wrong) => Err(self.wrong_entries(check, bank, generation, wrong)),
        }
    }

    fn wrong_entries(
        &mut self,
        check: CheckName,
        bank: Bank,
        generation: &Generation,
        wrong: &ReadBack,
    ) -> End {
        let entries = match wrong.port.table {
            Table::RowFactors | Table::Grid => generation.tables.entries().len(),
            Table::Kernel => generation.kernel.nodes().len(),
        };
        let found = match self.board.read_entries(bank, wrong.port, entries) {
            Ok(found) => found,
            Err(error) => {
                // Without the link the entry cannot be named. That the tables are wrong is certain all the same: the
                // board's CRC says it.
                tracing::warn!("the table was not read entry by entry: {error}");
                return End::failed(check, Finding::TableCrcWrong {});
            }
        };
        let suspects = diagnosis::read_back(generation, wrong.port.table, &found);
        let finding = match suspects.first().cloned() {
            Some(Suspect { defect, account, .. }) => {
                Finding::TableReadsWrong { defect: Box::new(defect), account }
            }
            None => Finding::TableCrcWrong {},
        };
        End::suspecting(check, finding, suspects)
    }
}
