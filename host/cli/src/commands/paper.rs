//! `halfrow paper`

use std::path::PathBuf;
use std::time::Instant;

use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use halfrow_program::files::prepare_files;

use super::{Context, Failure};
use crate::arguments::board::{self, BoardArguments, Replays};
use crate::arguments::given::{Decider, Given};
use crate::call_error::CallError;
use crate::console;
use crate::exit::Exit;
use crate::settings::Settings;
use halfrow::board::Board;
use halfrow::call::Files;
use halfrow::frames::preview::RgbImage;
use halfrow::progress::Progress;
use halfrow_lab::paper::{
    self, Claim, Exhibit, Folder, Item, MarkedError, MarkedPhotograph, Material, Outcome, PaperError,
    Synthesis, TestedBoard,
};

#[derive(Debug, Args)]
#[command(mut_args(|argument| board::helped(argument, Replays::No, " [default: mock, for the delay alone]")))]
pub(super) struct Arguments {
    #[command(flatten)]
    given: Given,
    /// What to reproduce [default: all]
    #[arg(value_name = "ITEM", value_parser = item_parser())]
    items: Vec<Item>,
    /// The folder of the 24 photographs, kodim01.png to kodim24.png
    #[arg(long, value_name = "FOLDER", env = "HALFROW_IMAGES")]
    images: Option<PathBuf>,
    /// A photograph by a fisheye lens, for Fig. 4 instead of the street
    #[arg(long, value_name = "FILE", requires = "lines")]
    photograph: Option<PathBuf>,
    /// Its image circle and its straight lines, as docs/paper.md describes them
    #[arg(long, value_name = "FILE", requires = "photograph")]
    lines: Option<PathBuf>,
    /// The report of `scripts/hardware resources`
    #[arg(long, value_name = "FILE", default_value = "target/hardware/resources/report.json")]
    synthesis: PathBuf,
    /// The folder to write to, made if it is not there
    #[arg(short, long, value_name = "FOLDER")]
    output: PathBuf,
    /// Replace an earlier page; what is not made this time is left beside it
    #[arg(long)]
    overwrite: bool,
    #[command(flatten)]
    board: BoardArguments,
}

fn item_parser() -> impl TypedValueParser<Value = Item> {
    let names = Item::ALL.map(|item| PossibleValue::new(item.name()).help(item.summary()));
    PossibleValuesParser::new(names).try_map(|name| Item::named(&name).ok_or(name))
}

pub(super) fn run(arguments: &Arguments, context: &Context) -> Result<Exit, Failure> {
    let begun = Instant::now();
    let items = arguments.items();
    let through_board = arguments.board.is_named(&context.settings);
    let uses_board = items.iter().any(|item| item.uses_board(through_board));
    let files = arguments.board.files_if(uses_board, arguments.overwrite, context)?;
    arguments.check(&items, uses_board, files, context).map_err(Failure::call)?;
    let photographs = arguments.photographs(&items);
    let photographs = photographs.map_err(|error| Failure::call(error).in_value_of("--images"))?;
    let marked = arguments.marked().map_err(Failure::call)?;
    let synthesis = arguments.synthesis(&items)?;
    let folder = Folder::prepare(&arguments.output, arguments.overwrite).map_err(Failure::call)?;
    let mut material = Material {
        photographs: &photographs,
        marked: marked.as_ref(),
        board: None,
        through_board,
        synthesis: &synthesis,
    };
    if uses_board {
        material.board = Some(arguments.open(&context.settings)?);
    }
    let exhibits = make(&items, &mut material, context.progress().as_ref());
    // Whatever has happened, the next run must find the board free.
    material.board.iter_mut().for_each(TestedBoard::close);
    let exhibits = exhibits?;
    let page = folder.write(&exhibits).map_err(Failure::error)?;
    let exit = Outcome::of(&exhibits).exit();
    if context.json {
        console::tell(&paper::document(&exhibits));
        return Ok(exit);
    }
    conclude(&exhibits);
    console::tell_line(&format!("wrote {} in {:.1} s", page.display(), begun.elapsed().as_secs_f64()));
    Ok(exit)
}

fn make(
    items: &[Item],
    material: &mut Material<'_>,
    watched: &dyn Progress,
) -> Result<Vec<Exhibit>, PaperError> {
    watched.rows_expected(items.iter().map(|&item| material.rows(item)).sum());
    let made = items.iter().map(|&item| {
        watched.frame(item.title());
        material.exhibit(item, watched)
    });
    let made = made.collect();
    watched.done();
    made
}

/// Prints every claim on a line.
fn conclude(exhibits: &[Exhibit]) {
    for exhibit in exhibits {
        console::tell(exhibit.item.title());
        for claim in &exhibit.claims {
            console::tell(&line(claim));
        }
        for open in &exhibit.open {
            console::tell(&format!("  open    {open}"));
        }
    }
}

fn line(claim: &Claim) -> String {
    let mark = match (claim.holds(), claim.judges_board) {
        (true, _) => "ok",
        (false, true) => "FAIL",
        (false, false) => "MISSED",
    };
    let paper = match (claim.paper, claim.deviation()) {
        (Some(paper), Some(deviation)) => format!("paper {paper}, {deviation:+.4}, "),
        _ => String::new(),
    };
    let found = format!("{} {}", claim.printed(), claim.unit);
    format!("  {mark:<7} {}: {} ({paper}{})", claim.what, found.trim_end(), claim.condition())
}

impl Arguments {
    /// The items in the paper's order, each once.
    fn items(&self) -> Vec<Item> {
        let wanted = |item: &Item| self.items.is_empty() || self.items.contains(item);
        Item::ALL.into_iter().filter(wanted).collect()
    }

    /// Refuses options without effect, and outputs that would replace existing files.
    fn check(&self, items: &[Item], uses_board: bool, files: Files, context: &Context) -> anyhow::Result<()> {
        let any = |is_meant: fn(Item) -> bool| items.iter().any(|&item| is_meant(item));
        for (is_wanted, decider) in [
            (uses_board, Decider::NO_BOARD_ITEM),
            (any(Item::needs_photographs), Decider::NO_PHOTOGRAPH_ITEM),
            (any(|item| item == Item::Fig4), Decider::NO_FIGURE_4),
            (any(|item| item == Item::Resources), Decider::NO_SYNTHESIS_ITEM),
        ] {
            if !is_wanted {
                self.given.refuse_void(decider, &context.settings.keys())?;
            }
        }
        let files = files
            .reads([&self.synthesis])
            .reads(&self.photograph)
            .reads(&self.lines)
            .writes_into("--output", Folder::files(&self.output, items));
        Ok(prepare_files(&files)?)
    }

    fn photographs(&self, items: &[Item]) -> anyhow::Result<Vec<RgbImage>> {
        if !items.iter().any(|item| item.needs_photographs()) {
            return Ok(Vec::new());
        }
        let Some(folder) = &self.images else {
            let names = |wanted: bool| {
                let chosen = Item::ALL.into_iter().filter(|item| item.needs_photographs() == wanted);
                chosen.map(Item::name).collect::<Vec<_>>().join(" ")
            };
            let needing = names(true).replace(' ', " and ");
            return Err(CallError::PhotographsMissing { needing, others: names(false) }.into());
        };
        Ok(paper::read_photographs(folder)?)
    }

    fn marked(&self) -> Result<Option<MarkedPhotograph>, MarkedError> {
        let [Some(photograph), Some(lines)] = [&self.photograph, &self.lines] else { return Ok(None) };
        MarkedPhotograph::read(photograph, lines).map(Some)
    }

    fn synthesis(&self, items: &[Item]) -> Result<Synthesis, PaperError> {
        match items.contains(&Item::Resources) {
            true if self.given.is_flag("synthesis") => Synthesis::read(&self.synthesis),
            true => Synthesis::read_if_there(&self.synthesis),
            false => Ok(Synthesis::none(&self.synthesis)),
        }
    }

    fn open(&self, settings: &Settings) -> Result<TestedBoard, Failure> {
        let candidate = self.board.candidate(settings)?;
        let options = self.board.open_options(settings)?;
        let board = Board::open(candidate.link, &options)?;
        Ok(TestedBoard::new(board, candidate.kind))
    }
}
