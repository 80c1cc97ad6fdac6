//! The tables that rows are made with, in two banks: one is written while rows use the other. A small build has a single bank
//! that serves as both.

mod defects;
mod error;

use std::sync::Arc;

use crate::core::{GridShape, Kernel, NODES, Node, RowValues, UNSTRETCHED};
use crate::faults::{BoardFault, Defects};
use crate::options::{Options, TapCount};
use crate::settings::Settings;

use defects::flipped;

pub(crate) use defects::{Drift, FlippedBit, Stale, TableDefects};
pub use error::TableError;

/// The largest entry of a grid.
pub(crate) const MOST_GRID_ENTRY: u32 = (1 << 25) - 1;

/// The claimed blanking between rows of a grid that are narrower than the claimed width. The mock needs none.
pub(crate) const GRID_BLANKING: u8 = 32;
pub(crate) const GRID_WIDTH: u16 = 144;

/// A bank of tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bank {
    /// The one that is written.
    Shadow,
    /// The one that rows use.
    Active,
}

/// Who reads a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Port {
    /// The datapath, when a row begins.
    Datapath,
    /// The host, to see what the datapath sees.
    ReadBack,
}

/// What a row takes from the tables when its first sample enters.
#[derive(Clone, Debug)]
pub struct Bound {
    /// Where its columns come from.
    pub values: RowValues,
    /// The kernel.
    pub kernel: Arc<Kernel>,
    /// The generation that the row will name.
    pub generation: u8,
}

/// The contents of one bank.
#[derive(Debug)]
struct Contents {
    /// Row factors or a grid.
    entries: Vec<u32>,
    /// The shape of a grid; none for row factors.
    shape: Option<GridShape>,
    kernel: Arc<Kernel>,
    generation: u8,
}

/// A commit that has not taken effect yet.
#[derive(Debug)]
struct Commit {
    generation: u8,
    first_frame: u16,
}

/// The banks of tables, and what is wrong with them.
#[derive(Debug)]
pub struct Tables {
    /// None if there is one bank: then the active bank itself is written.
    shadow: Option<Contents>,
    active: Contents,
    commit: Option<Commit>,
    taps: TapCount,
    /// The number of entries that can hold row factors.
    max_height: usize,
    defects: TableDefects,
    rows_bound: u32,
}

impl Tables {
    /// The tables of a board that was just switched on: generation 0, nothing stretched, all weights zero.
    #[must_use]
    pub fn new(options: &Options, fault: Option<BoardFault>) -> Self {
        let contents = || Contents {
            entries: vec![UNSTRETCHED; options.bank_entries().into()],
            shape: None,
            kernel: Arc::default(),
            generation: 0,
        };
        Self {
            shadow: (options.table_banks > 1).then(contents),
            active: contents(),
            commit: None,
            taps: options.taps,
            max_height: options.max_height.into(),
            defects: Defects::of(fault).tables,
            rows_bound: 0,
        }
    }

    /// Writes factors into the shadow bank, starting with row `first`: all of them or, on an error, none. If there is at least
    /// one, the bank then holds row factors, whatever it held before.
    ///
    /// # Errors
    /// If a row is not in the table, a factor is outside 1 to 2^24, or the shadow bank has been committed and waits for its
    /// frame.
    pub fn write_factors(&mut self, first: usize, factors: &[u32]) -> Result<(), TableError> {
        self.check_writable()?;
        let max_height = self.max_height;
        let entries = span(&mut self.shadow_mut().entries[..max_height], first, factors.len())?;
        if let Some(place) = factors.iter().position(|factor| !(1..=UNSTRETCHED).contains(factor)) {
            return Err(TableError::Factor { row: first + place, factor: factors[place] });
        }
        entries.copy_from_slice(factors);
        if !factors.is_empty() {
            self.shadow_mut().shape = None;
        }
        Ok(())
    }

    /// Writes entries of a grid into the shadow bank, into the same memory as row factors, starting with entry `first`: all of
    /// them or, on an error, none.
    ///
    /// # Errors
    /// If an entry is not in the bank, a value is above 2^25 − 1, or the shadow bank has been committed and waits for its
    /// frame.
    pub fn write_grid(&mut self, first: usize, values: &[u32]) -> Result<(), TableError> {
        self.check_writable()?;
        let entries = span(&mut self.shadow_mut().entries, first, values.len())?;
        if let Some(place) = values.iter().position(|&value| value > MOST_GRID_ENTRY) {
            return Err(TableError::GridEntry { entry: first + place, value: values[place] });
        }
        entries.copy_from_slice(values);
        Ok(())
    }

    /// Writes kernel nodes into the shadow bank, starting with node `first`: all of them or, on an error, none.
    ///
    /// # Errors
    /// If a node is not in the kernel or needs taps that the build lacks, or the shadow bank has been committed and waits for
    /// its frame.
    pub fn write_nodes(&mut self, first: usize, nodes: &[Node]) -> Result<(), TableError> {
        self.check_writable()?;
        let five = self.taps == TapCount::Five;
        let entries = span(&mut Arc::make_mut(&mut self.shadow_mut().kernel).nodes, first, nodes.len())?;
        if five && let Some(place) = nodes.iter().position(Node::needs_outer_taps) {
            return Err(TableError::OuterTaps { node: first + place });
        }
        entries.copy_from_slice(nodes);
        Ok(())
    }

    /// Commits the row factors of the shadow bank: from row 0 of `first_frame` on it is the active bank with this generation.
    /// With a single bank this takes effect at once.
    ///
    /// # Errors
    /// If an earlier commit has not taken effect yet.
    pub fn commit(&mut self, generation: u8, first_frame: u16) -> Result<(), TableError> {
        self.commit_shape(generation, first_frame, None)
    }

    /// Commits the shadow bank like [`Self::commit`], as a grid of this shape or, without a shape, as row factors.
    ///
    /// # Errors
    /// If an earlier commit has not taken effect yet.
    pub fn commit_shape(
        &mut self,
        generation: u8,
        first_frame: u16,
        shape: Option<GridShape>,
    ) -> Result<(), TableError> {
        self.check_writable()?;
        self.shadow_mut().shape = shape;
        if self.shadow.is_some() {
            self.commit = Some(Commit { generation, first_frame });
        } else {
            self.begin(generation);
        }
        Ok(())
    }

    /// Starts row 0 of `frame`: a commit for this frame takes effect.
    pub fn start_frame(&mut self, frame: u16) {
        if let Some(commit) = self.commit.take_if(|commit| commit.first_frame == frame) {
            if let Some(shadow) = &mut self.shadow {
                std::mem::swap(shadow, &mut self.active);
            }
            self.begin(commit.generation);
        }
    }

    /// What the row that begins now is bound to, in a frame with these settings.
    pub fn bind(&mut self, row: u16, settings: &Settings) -> Bound {
        self.bind_from(Bank::Active, row, settings)
    }

    /// What a row that begins now is bound to, with the tables of this bank.
    pub(crate) fn bind_from(&mut self, bank: Bank, row: u16, settings: &Settings) -> Bound {
        self.drift();
        let (bank, named_after) = match self.defects.stale {
            None => (bank, bank),
            Some(Stale::Admitted) => (Bank::Shadow, Bank::Shadow),
            Some(Stale::Hidden) => (Bank::Shadow, bank),
        };
        Bound {
            values: self.values(bank, row, settings),
            kernel: self.kernel(bank, Port::Datapath),
            generation: self.contents(named_after).generation,
        }
    }

    /// The values of a row in a frame with these settings, as the datapath makes them from a bank.
    fn values(&self, bank: Bank, row: u16, settings: &Settings) -> RowValues {
        let Contents { entries, shape, .. } = self.contents(bank);
        // An address beyond the bank wraps: the frame may have become larger since its grid was committed.
        let read = |index: usize| {
            let wrapped = index.checked_rem(entries.len());
            wrapped.and_then(|index| self.entry(bank, index, Port::Datapath)).unwrap_or(UNSTRETCHED)
        };
        match shape {
            None => read(row.into()).into(),
            Some(shape) => RowValues::of_grid(*shape, (settings.width, settings.height), row, read),
        }
    }

    /// An entry of a bank as a port sees it, whether it is a row factor or a grid's; none beyond the end of the bank.
    #[must_use]
    pub fn entry(&self, bank: Bank, index: usize, port: Port) -> Option<u32> {
        let stored = *self.contents(bank).entries.get(index)?;
        let flip = self.defects.entry.filter(|flip| index == usize::from(flip.entry) && flip.shows(port));
        Some(flip.map_or(stored, |flip| flipped(stored, flip.bit)))
    }

    /// The kernel as a port sees it.
    #[must_use]
    pub fn kernel(&self, bank: Bank, port: Port) -> Arc<Kernel> {
        let mut kernel = Arc::clone(&self.contents(bank).kernel);
        if let Some(FlippedBit { entry: (node, weight), bit, .. }) =
            self.defects.word.filter(|flip| flip.shows(port))
            && usize::from(node) < NODES
        {
            let word = Arc::make_mut(&mut kernel).nodes[usize::from(node)].word_mut(weight);
            *word = flipped(u32::from(word.cast_unsigned()), bit) as i16;
        }
        kernel
    }

    /// The claimed blanking between rows of `width` samples, with the tables of both banks by turns.
    pub(crate) fn claimed_blanking(&self, width: u16) -> u16 {
        let has_grid = [Bank::Active, Bank::Shadow].iter().any(|&bank| self.contents(bank).shape.is_some());
        if has_grid && width < GRID_WIDTH { GRID_BLANKING.into() } else { 0 }
    }

    /// The generation of the active bank; 0 before the first commit takes effect.
    #[must_use]
    pub fn generation(&self) -> u8 {
        self.active.generation
    }

    /// The generation of the shadow bank, which rows have that entered before the last commit took effect.
    #[must_use]
    pub(crate) fn shadow_generation(&self) -> u8 {
        self.contents(Bank::Shadow).generation
    }

    /// Whether a commit has not taken effect yet.
    #[must_use]
    pub(crate) fn has_commit(&self) -> bool {
        self.commit.is_some()
    }

    /// Whether a commit is accepted whatever the tables read back as.
    pub(crate) fn is_unchecked(&self) -> bool {
        self.defects.unchecked
    }

    /// Whether this generation is the active one or belongs to the pending commit.
    #[must_use]
    pub(crate) fn has_generation(&self, generation: u8) -> bool {
        let waits = self.commit.as_ref().is_some_and(|commit| commit.generation == generation);
        waits || generation != 0 && self.active.generation == generation
    }

    /// Whether there will be committed tables when row 0 of `frame` enters.
    #[must_use]
    pub(crate) fn are_ready_for(&self, frame: u16) -> bool {
        self.active.generation != 0 || self.commit.as_ref().is_some_and(|commit| commit.first_frame == frame)
    }

    /// Drops a commit that has not taken effect. Its tables stay in the shadow bank.
    pub(crate) fn forget_commit(&mut self) {
        self.commit = None;
    }

    fn contents(&self, bank: Bank) -> &Contents {
        match bank {
            Bank::Shadow => self.shadow.as_ref().unwrap_or(&self.active),
            Bank::Active => &self.active,
        }
    }

    fn shadow_mut(&mut self) -> &mut Contents {
        self.shadow.as_mut().unwrap_or(&mut self.active)
    }

    /// Makes the contents of the active bank a new generation.
    fn begin(&mut self, generation: u8) {
        self.active.generation = generation;
        self.rows_bound = 0;
    }

    fn check_writable(&self) -> Result<(), TableError> {
        match self.commit {
            Some(Commit { first_frame, .. }) => Err(TableError::CommitPending { first_frame }),
            None => Ok(()),
        }
    }

    /// Flips a drifting entry's bit once its time has come.
    fn drift(&mut self) {
        if let Some(Drift { after, entry, bit }) = self.defects.drift
            && after == self.rows_bound
            && let Some(entry) = self.active.entries.get_mut(usize::from(entry))
        {
            *entry = flipped(*entry, bit);
        }
        self.rows_bound = self.rows_bound.wrapping_add(1);
    }
}

/// The entries `first` to `first + count` of a table.
fn span<T>(table: &mut [T], first: usize, count: usize) -> Result<&mut [T], TableError> {
    let entries = table.len();
    let end = first.saturating_add(count);
    table.get_mut(first..end).ok_or(TableError::NoSuchEntry { entry: end.saturating_sub(1), entries })
}
