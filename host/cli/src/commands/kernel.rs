//! `halfrow kernel`

use std::collections::HashMap;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

use anyhow::Context as _;
use clap::{Args, Subcommand, ValueEnum};
use halfrow_model::{Kernel, Taps};
use halfrow_program::files::prepare_files;
use serde::Serialize;
use serde_json::{Map, Value, json};

use super::{Context, Failure, print};
use crate::arguments::optics;
use crate::call_error::CallError;
use crate::console;
use crate::document::{print_result, tell_result};
use crate::exit::Exit;
use halfrow::files::check_regular;
use halfrow::frames::preview::RgbImage;
use halfrow::frames::{FrameFile, landscape};
use halfrow::result::sha256;
use halfrow::tables::KernelFile;
use halfrow::words::{count, plain_lines};
use halfrow_lab::training;
use halfrow_lab::training::{
    Gains, Model, RIDGE, Spread, Trained, TrainingError, measure, noise_gain, train,
};

#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Train(Train),
    Measure(Measure),
}

/// Fit the kernel that brings corrected photographs nearest to the photographs
///
/// Each photograph is distorted by several lenses, with the linear warp of the paper's experiment and with a band-limited one,
/// and the 65 nodes are found by least squares. The same photographs always give the same kernel.
#[derive(Debug, Args)]
struct Train {
    /// Folders of PNG photographs in colour, 8 bits; not those that the kernel will be judged by
    #[arg(long, value_name = "FOLDER", required = true, num_args = 1..)]
    images: Vec<PathBuf>,
    /// How many samples an output may be made of; every board has five
    #[arg(long, value_enum, default_value = "5")]
    taps: TapCount,
    /// The kernel file to write
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Replace a file that is there
    #[arg(long)]
    overwrite: bool,
}

/// Measure what a kernel gains over Hermite on photographs
///
/// The lens is that of the paper's Table 1 (R is 1.5 times half the height, 384 for the 24 photographs of Kodak's PhotoCD).
#[derive(Debug, Args)]
struct Measure {
    /// Folders of PNG photographs in colour, 8 bits
    #[arg(long, value_name = "FOLDER", required = true, num_args = 1..)]
    images: Vec<PathBuf>,
    #[arg(long, help = optics::kernel_help(""), value_name = "NAME|FILE")]
    kernel: OsString,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum TapCount {
    #[value(name = "5")]
    Five,
    #[value(name = "7")]
    Seven,
}

pub(super) fn run(arguments: &Arguments, context: &Context) -> Result<Exit, Failure> {
    match &arguments.command {
        Command::Train(train) => fit(train, context),
        Command::Measure(measure) => judge(measure, context),
    }
}

/// Where a photograph comes from, as noted in a kernel file.
#[derive(Serialize)]
struct Origin {
    name: Option<String>,
    sha256: String,
}

/// The PNG files of the folders in the order of their names.
fn paths(folders: &[PathBuf]) -> anyhow::Result<Vec<PathBuf>> {
    let mut paths = Vec::new();
    for folder in folders {
        let unlisted = |source| CallError::FolderUnlisted { path: folder.clone(), source };
        paths.extend(pictures(folder).map_err(unlisted)?);
    }
    if paths.is_empty() { Err(CallError::NoPhotograph.into()) } else { Ok(paths) }
}

/// The photographs, none of which may count twice. Those that are higher than wide are turned by a quarter.
fn photographs(paths: &[PathBuf]) -> anyhow::Result<(Vec<Origin>, Vec<RgbImage>)> {
    let photographs: anyhow::Result<Vec<_>> = paths.iter().map(|path| photograph(path)).collect();
    let (origins, images): (Vec<Origin>, _) = photographs?.into_iter().unzip();
    check_apart(paths, &origins)?;
    Ok((origins, images))
}

fn check_apart(paths: &[PathBuf], origins: &[Origin]) -> Result<(), CallError> {
    let mut seen = HashMap::new();
    for (path, origin) in paths.iter().zip(origins) {
        if let Some(first) = seen.insert(&origin.sha256, path) {
            return Err(CallError::PhotographTwice { first: first.clone(), second: path.clone() });
        }
    }
    Ok(())
}

fn photograph(path: &Path) -> anyhow::Result<(Origin, RgbImage)> {
    check_regular(path)?;
    let file = FrameFile::read(path)?;
    let image = landscape(file.decode_rgb()?);
    training::check(&image).with_context(|| format!("{} cannot be used", path.display()))?;
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned());
    Ok((Origin { name, sha256: sha256([file.bytes()]) }, image))
}

fn pictures(folder: &Path) -> std::io::Result<Vec<PathBuf>> {
    let entries: std::io::Result<Vec<_>> =
        std::fs::read_dir(folder)?.map(|entry| entry.map(|entry| entry.path())).collect();
    let mut paths = entries?;
    paths.retain(|path| path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png")));
    paths.sort();
    Ok(paths)
}

fn fit(arguments: &Train, context: &Context) -> Result<Exit, Failure> {
    let paths = paths(&arguments.images).map_err(Failure::call)?;
    // Training takes minutes; a refusal after that would come too late.
    let files = context.files(arguments.overwrite).reads(&paths);
    prepare_files(&files.writes("--output", [&arguments.output])).map_err(Failure::call)?;
    let (origins, images) = photographs(&paths).map_err(Failure::call)?;
    let taps = match arguments.taps {
        TapCount::Five => Taps::Five,
        TapCount::Seven => Taps::Seven,
    };
    let watched = context.progress();
    watched.rows_expected(rows(&images));
    let trained = train(&images, taps, watched.as_ref());
    watched.done();
    let trained = trained.map_err(failed)?;
    let about = about(&origins, &trained).map_err(Failure::error)?;
    let file = KernelFile { about: Some(about), kernel: trained.kernel.clone() };
    file.write(&arguments.output, arguments.overwrite).map_err(Failure::error)?;
    if context.json {
        let rest = json!({
            "file": arguments.output.display().to_string(), "photographs": images.len(), "gain_db": trained.gain,
            "held_out_db": held_out(&trained), "mean_noise_gain": mean_noise_gain(&trained.kernel),
        });
        tell_result("kernel", rest)?;
        return Ok(Exit::Pass);
    }
    console::tell(&format!(
        "{}: {} over Hermite on them; each by the kernel of the others {}; noise gain {:.3}",
        count(images.len(), "photograph"),
        trained.gain.map_or_else(|| "no measured gain".to_owned(), |gain| format!("{gain:+.2} dB")),
        held_out_text(&trained),
        mean_noise_gain(&trained.kernel)
    ));
    console::tell_line(&format!("wrote {}", arguments.output.display()));
    Ok(Exit::Pass)
}

/// The gains of photographs with a kernel trained on the others, as far as measured.
fn held_out(trained: &Trained) -> Option<Spread> {
    Spread::of(&trained.held_out.iter().flatten().copied().collect::<Vec<_>>())
}

fn held_out_text(trained: &Trained) -> String {
    let Some(Spread { mean, least, most }) = held_out(trained) else { return "not measured".to_owned() };
    let measured = trained.held_out.iter().flatten().count();
    let some =
        if measured < trained.held_out.len() { format!(", of {measured} of them") } else { String::new() };
    format!("{mean:+.2} dB ({least:+.2} to {most:+.2}{some})")
}

/// Where a kernel comes from, as noted in its file.
fn about(origins: &[Origin], trained: &Trained) -> anyhow::Result<Map<String, Value>> {
    let model = |model: Model| json!({"warp": model.warp.name(), "radius_by_half_height": model.radius});
    let mut about = Map::new();
    about.insert("made_by".to_owned(), format!("halfrow {} kernel train", halfrow::VERSION).into());
    about.insert("images".to_owned(), serde_json::to_value(origins)?);
    about.insert("models".to_owned(), Model::ALL.map(model).to_vec().into());
    about.insert("ridge".to_owned(), RIDGE.into());
    about.insert(
        "figures".to_owned(),
        json!({
            "gain_over_hermite_db": trained.gain.map(rounded),
            "held_out_gains_db": trained.held_out.iter().map(|gain| gain.map(rounded)).collect::<Vec<_>>(),
            "mean_noise_gain": rounded(mean_noise_gain(&trained.kernel)),
        }),
    );
    Ok(about)
}

fn failed(error: TrainingError) -> Failure {
    Failure::of(error.class().into(), error)
}

fn rounded(figure: f64) -> f64 {
    (figure * 1000.0).round() / 1000.0
}

fn mean_noise_gain(kernel: &Kernel) -> f64 {
    let gains = noise_gain(kernel);
    gains.iter().sum::<f64>() / gains.len() as f64
}

fn rows(images: &[RgbImage]) -> u64 {
    images.iter().map(|image| image.height as u64).sum()
}

fn judge(arguments: &Measure, context: &Context) -> Result<Exit, Failure> {
    let kernel = halfrow::optics::kernel(&arguments.kernel)?;
    let (_, images) =
        photographs(&paths(&arguments.images).map_err(Failure::call)?).map_err(Failure::call)?;
    let watched = context.progress();
    watched.rows_expected(rows(&images));
    let measured = measure(&images, &kernel, watched.as_ref());
    watched.done();
    let (measured, noise) = (measured.map_err(failed)?, Spread::of(&noise_gain(&kernel)));
    let name = arguments.kernel.to_string_lossy();
    if context.json {
        let rest = json!({ "kernel": name, "gains_db": measured, "noise_gain": noise });
        print_result("kernel", rest)?;
        return Ok(Exit::Pass);
    }
    let mut lines = vec![format!("{name} on {}, over Hermite in dB", count(images.len(), "photograph"))];
    lines.extend(measured.iter().map(gains_text));
    lines.extend(
        noise.map(|Spread { mean, least, most }| format!("  noise gain {mean:.3} ({least:.3} to {most:.3})")),
    );
    print(&plain_lines(&lines))?;
    Ok(Exit::Pass)
}

fn gains_text(gains: &Gains) -> String {
    let exact = match gains.exact {
        0 => String::new(),
        1 => "; 1 photograph comes back exactly, and is left out".to_owned(),
        more => format!("; {} come back exactly, and are left out", count(more, "photograph")),
    };
    match gains.gain.zip(gains.hermite) {
        Some((Spread { mean, least, most }, hermite)) => {
            format!("  {mean:+.3} ({least:+.3} to {most:+.3})  {}, {hermite:.4}{exact}", gains.condition)
        }
        None => format!("  no figure  {}{exact}", gains.condition),
    }
}
