//! Table 1: the PSNR of 24 photographs for each interpolation, in double precision, in integers, and through a board.

use std::sync::Arc;

use halfrow_model::{Frame, Interpolant, Kernel};

use super::exhibit::{Accepted, Cell, Claim, Exhibit, Table, largest};
use super::expected::{
    AVERAGE_TOLERANCE, INTEGER_TOLERANCE, METHODS, PSNR_TOLERANCE, TABLE_1, TABLE_1_AVERAGES,
};
use super::experiment::{Experiment, Trial};
use super::tested_board::TestedBoard;
use super::{Item, PaperError};
use halfrow::frames::preview::RgbImage;
use halfrow::progress::Progress;

/// All interpolants, including nearest, which the paper's table leaves out.
pub(super) const ALL: [Interpolant; 4] = Interpolant::ALL;

/// The paper's name of an interpolation.
pub(super) fn name(interpolant: Interpolant) -> &'static str {
    match interpolant {
        Interpolant::Nearest => "nearest",
        Interpolant::Linear => "linear",
        Interpolant::Keys => "cubic",
        Interpolant::Hermite => "Hermite",
    }
}

/// PSNR in dB of each photograph by each of [`ALL`].
type Scores = Vec<[f64; 4]>;

/// The result of the photographs through the board.
struct ThroughBoard {
    scores: Scores,
    /// Samples that differ from the integer model's, by interpolation.
    differences: [u64; 4],
    samples: u64,
}

/// The table. With a board, every photograph also goes through the board with every kernel.
pub(super) fn exhibit(
    photographs: &[RgbImage],
    board: Option<&mut TestedBoard>,
    progress: &dyn Progress,
) -> Result<Exhibit, PaperError> {
    let experiment = Experiment::new()?;
    let mut trials = Vec::with_capacity(photographs.len());
    let (mut real, mut integer) = (Scores::new(), Scores::new());
    for (index, photograph) in photographs.iter().enumerate() {
        progress.frame(&format!("Table 1, photograph {}", index + 1));
        let trial = experiment.trial(photograph)?;
        real.push(scores(&trial, |interpolant| experiment.by_reals(interpolant, &trial))?);
        integer.push(scores(&trial, |interpolant| experiment.by_integers(interpolant, &trial))?);
        trials.push(trial);
        progress.rows(photograph.height as u64);
    }
    let mut exhibit = Exhibit::new(Item::Table1);
    remarks(&mut exhibit);
    claims(&mut exhibit, &real, &integer);
    exhibit.tables.push(beside_the_paper(&real));
    exhibit.tables.push(by_kernel("table-1-integers", "PSNR in dB by the integer datapath.", &integer));
    if let Some(board) = board {
        let through = through_board(&experiment, &trials, board, progress)?;
        judge(&mut exhibit, board, &through, &real);
        exhibit.tables.push(by_kernel("table-1-board", "PSNR in dB through the board.", &through.scores));
    }
    Ok(exhibit)
}

fn scores(
    trial: &Trial,
    corrected: impl Fn(Interpolant) -> Result<Frame, PaperError>,
) -> Result<[f64; 4], PaperError> {
    let mut found = [0.0; 4];
    for (score, interpolant) in found.iter_mut().zip(ALL) {
        *score = trial.score(corrected(interpolant)?.samples());
    }
    Ok(found)
}

fn through_board(
    experiment: &Experiment,
    trials: &[Trial],
    board: &mut TestedBoard,
    progress: &dyn Progress,
) -> Result<ThroughBoard, PaperError> {
    for interpolant in ALL {
        board.fits(experiment.tables(), &Kernel::from(interpolant))?;
    }
    let inputs: Vec<Arc<Frame>> = trials.iter().map(|trial| Arc::clone(&trial.distorted)).collect();
    let mut found = ThroughBoard { scores: vec![[0.0; 4]; trials.len()], differences: [0; 4], samples: 0 };
    for (method, interpolant) in ALL.into_iter().enumerate() {
        progress.frame(&format!("Table 1, {} through the board", name(interpolant)));
        let corrected = board.correct(experiment.tables(), &Kernel::from(interpolant), &inputs, progress)?;
        for ((trial, samples), scores) in trials.iter().zip(&corrected.samples).zip(&mut found.scores) {
            let expected = experiment.by_integers(interpolant, trial)?;
            let pairs = expected.samples().iter().zip(samples);
            found.differences[method] += pairs.filter(|(expected, found)| expected != found).count() as u64;
            found.samples += samples.len() as u64;
            scores[method] = trial.score(samples);
        }
    }
    Ok(found)
}

fn averages(scores: &Scores) -> [f64; 4] {
    std::array::from_fn(|method| scores.iter().map(|row| row[method]).sum::<f64>() / scores.len() as f64)
}

/// The place in [`ALL`] of the method with this place in [`METHODS`].
fn place(method: usize) -> usize {
    ALL.iter().position(|&interpolant| interpolant == METHODS[method]).unwrap_or_default()
}

fn remarks(exhibit: &mut Exhibit) {
    exhibit.remark(
        "Each photograph, turned to lie, is distorted by the reciprocal of Eqs. 8 and 9 with R = 384 (straight lines \
         between pixels, truncated to 8 bits), mosaicked to GRBG, corrected, and compared with the photograph mosaicked \
         as it was (Eq. 19). Nothing is cropped.",
    );
    exhibit.remark(
        "The paper leaves turning, truncation and edges open; these choices come nearest to its table.",
    );
}

/// The averages, the photograph that is farthest off, and the loss by integers.
fn claims(exhibit: &mut Exhibit, real: &Scores, integer: &Scores) {
    let (real_averages, integer_averages) = (averages(real), averages(integer));
    for (method, paper) in TABLE_1_AVERAGES.into_iter().enumerate() {
        exhibit.claims.push(Claim {
            what: format!("average PSNR, {}", name(METHODS[method])),
            unit: "dB",
            paper: Some(paper),
            found: real_averages[place(method)],
            accepted: Accepted::Within(AVERAGE_TOLERANCE),
            judges_board: false,
        });
    }
    let deviations = real.iter().zip(TABLE_1).flat_map(|(found, paper)| {
        paper.into_iter().enumerate().map(|(method, paper)| (found[place(method)] - paper).abs())
    });
    let deviations: Vec<f64> = deviations.collect();
    exhibit.claims.push(at_most(
        "largest deviation of a photograph from the paper",
        largest(deviations.iter().copied()),
        PSNR_TOLERANCE,
    ));
    exhibit.remark(format!(
        "The {} figures of the paper are missed by {:.3} dB on average.",
        deviations.len(),
        deviations.iter().sum::<f64>() / deviations.len() as f64
    ));
    exhibit.claims.push(at_most(
        "largest difference of an average in integers from double precision",
        farthest(&integer_averages, &real_averages),
        INTEGER_TOLERANCE,
    ));
}

fn judge(exhibit: &mut Exhibit, board: &TestedBoard, through: &ThroughBoard, real: &Scores) {
    exhibit.remark(format!(
        "The {} took all four kernels and corrected {} samples in {} frames.",
        board.name(),
        through.samples,
        4 * through.scores.len()
    ));
    let claims = ALL.into_iter().zip(through.differences).map(|(interpolant, differences)| Claim {
        what: format!("samples of the board unlike the integer model's, {}", name(interpolant)),
        unit: "",
        paper: None,
        found: differences as f64,
        accepted: Accepted::UpTo(0.0),
        judges_board: true,
    });
    exhibit.claims.extend(claims);
    // A board whose samples are all right misses this only where the integer model does.
    exhibit.claims.push(at_most(
        "largest difference of an average through the board from double precision",
        farthest(&averages(&through.scores), &averages(real)),
        INTEGER_TOLERANCE,
    ));
}

/// The largest difference between two averages of one of [`METHODS`]. Nearest is left out: its jump becomes a ramp between two
/// nodes of a kernel table.
fn farthest(found: &[f64; 4], real: &[f64; 4]) -> f64 {
    let difference = |method| (found[place(method)] - real[place(method)]).abs();
    largest((0..METHODS.len()).map(difference))
}

fn at_most(what: &str, found: f64, most: f64) -> Claim {
    let what = what.to_owned();
    Claim { what, unit: "dB", paper: None, found, accepted: Accepted::UpTo(most), judges_board: false }
}

/// For each of the paper's methods the paper's figures, those in double precision, and the deviation; then nearest.
fn beside_the_paper(real: &Scores) -> Table {
    let heads = METHODS.into_iter().flat_map(|method| {
        let name = name(method);
        [format!("{name}, paper"), name.to_owned(), "deviation".to_owned()]
    });
    let columns = std::iter::once("photograph".to_owned()).chain(heads).chain(["nearest".to_owned()]);
    let row = |name: String, paper: &[f64; 3], found: &[f64; 4]| {
        let cells = paper.iter().enumerate().flat_map(|(method, &paper)| {
            let found = found[place(method)];
            [paper, found, found - paper]
        });
        let numbers = cells.chain([found[0]]).map(|number| Cell::Number(number, 4));
        std::iter::once(Cell::Text(name)).chain(numbers).collect()
    };
    let photographs = TABLE_1.iter().zip(real).enumerate();
    let photographs = photographs.map(|(index, (paper, found))| row((index + 1).to_string(), paper, found));
    Table {
        name: "table-1",
        caption: "PSNR in dB in double precision, beside Table 1. The paper gives none for nearest."
            .to_owned(),
        columns: columns.collect(),
        rows: photographs.chain([row("average".to_owned(), &TABLE_1_AVERAGES, &averages(real))]).collect(),
        on_page: true,
    }
}

fn by_kernel(name: &'static str, caption: &str, scores: &Scores) -> Table {
    let row = |name: String, scores: &[f64; 4]| {
        let numbers = scores.iter().map(|&score| Cell::Number(score, 4));
        std::iter::once(Cell::Text(name)).chain(numbers).collect()
    };
    let photographs = scores.iter().enumerate().map(|(index, scores)| row((index + 1).to_string(), scores));
    let heads = ALL.map(|interpolant| self::name(interpolant).to_owned());
    Table {
        name,
        caption: caption.to_owned(),
        columns: std::iter::once("photograph".to_owned()).chain(heads).collect(),
        rows: photographs.chain([row("average".to_owned(), &averages(scores))]).collect(),
        on_page: true,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Flat photographs come out equal, so that their PSNR is infinite.
    #[test]
    fn averages_that_cannot_be_compared_are_not_accepted() {
        let mut exhibit = Exhibit::new(Item::Table1);
        let flat = vec![[f64::INFINITY; 4]; TABLE_1.len()];
        claims(&mut exhibit, &flat, &flat);
        assert_eq!(exhibit.claims.iter().filter(|claim| claim.holds()).count(), 0);
    }
}
