//! Turns `[tables]` into what a board is judged with.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use halfrow::FrameSource;
use halfrow::call::{Input, check_size};
use halfrow::frames::{Builtin, FrameFile, PictureSize, ReadOptions};
use halfrow::model::{BitDepth, Equidistant, Geometry, Phase};
use halfrow::optics::{self, Chosen, Optics, OpticsError, TablesBy, View};
use halfrow::tables::TableFile;
use toml::Spanned;

use super::files::Files;
use super::text::{RowsText, TablesText};
use crate::input_error::{At, Fault};

/// What was chosen, and what its table file was read from, if it has one.
type FromFile = (Chosen, Option<Input>);

impl TablesText {
    /// These tables, with what `over` says instead. A lens, a file and a radius replace one another.
    pub(super) fn under(&self, over: &Self) -> Self {
        let has_source = over.lens.is_some() || over.file.is_some() || over.radius.is_some();
        let below = if has_source { &Self::default() } else { self };
        Self {
            lens: over.lens.clone().or_else(|| below.lens.clone()),
            file: over.file.clone().or_else(|| below.file.clone()),
            radius: over.radius.clone().or_else(|| below.radius.clone()),
            width: over.width.clone().or_else(|| self.width.clone()),
            height: over.height.clone().or_else(|| self.height.clone()),
            bits: over.bits.clone().or_else(|| self.bits.clone()),
            phase: over.phase.or(self.phase),
            rows: over.rows.or(self.rows),
            kernel: over.kernel.clone().or_else(|| self.kernel.clone()),
            instead: over.place().or(self.instead),
        }
    }

    /// Where in the plan these tables are, for errors; none if they are the built-in ones. What a step or a variant says instead
    /// comes first, as the plan's own may be right.
    fn place(&self) -> Option<usize> {
        let named = self.file.as_ref().or(self.lens.as_ref()).map(At::at);
        let radius = || self.radius.as_ref().map(At::at);
        let size = || self.width.as_ref().or(self.height.as_ref()).map(At::at);
        self.instead.or(named).or_else(radius).or_else(size)
    }

    /// Chooses tables, kernel and lens. `step` is the place in the plan of the step that needs them.
    pub(super) fn choose(&self, files: &mut Files, step: usize) -> Result<Chosen, Fault> {
        self.check()?;
        let kernel = self.kernel.as_ref().map(|name| kernel(name, files)).transpose()?;
        let kernel = kernel.as_deref().map(Path::as_os_str);
        let at = self.place().unwrap_or(step);
        let chosen = match (&self.file, &self.lens) {
            (Some(name), _) => self.of_file(&files.find(name)?, kernel),
            (None, Some(name)) => self.of_lens(&files.find(name)?, kernel),
            (None, None) => self.of_radius(kernel),
        };
        let (chosen, table_file) =
            chosen.map_err(|error| Fault::input(at, "what the plan says of tables", error))?;
        let read = [
            (&self.kernel, chosen.kernel_file.clone()),
            (&self.file, table_file),
            (&self.lens, chosen.optics.file.clone()),
        ];
        for (name, read) in read {
            if let (Some(name), Some(read)) = (name, read) {
                files.note(name, read)?;
            }
        }
        Ok(chosen)
    }

    /// Refuses contradictions, and depths that no sample has.
    fn check(&self) -> Result<(), Fault> {
        self.depth()?;
        let named = [
            self.file.as_ref().map(|name| ("file", name.at())),
            self.lens.as_ref().map(|name| ("lens", name.at())),
            self.radius.as_ref().map(|radius| ("radius", radius.at())),
        ];
        let mut named = named.into_iter().flatten();
        if let (Some((first, _)), Some((second, at))) = (named.next(), named.next()) {
            let what = format!("tables are said by `{first}` and by `{second}`");
            return Err(Fault::wrong(at, what, "keep one of them"));
        }
        let sized = [&self.width, &self.height].into_iter().flatten().next();
        if let (Some(_), Some(size)) = (&self.file, sized) {
            let what = "a file of tables has a size of its own";
            return Err(Fault::wrong(size, what, "leave `width` and `height` out"));
        }
        Ok(())
    }

    fn depth(&self) -> Result<BitDepth, Fault> {
        let Some(bits) = &self.bits else { return Ok(BitDepth::default()) };
        BitDepth::from_bits(*bits.get_ref()).ok_or_else(|| {
            let what = format!("a sample has no {} bits", bits.get_ref());
            Fault::wrong(bits, what, "write 8, 10 or 12")
        })
    }

    fn view(&self) -> View {
        let of = |given: &Option<Spanned<usize>>| given.as_ref().map(|size| *size.get_ref());
        let depth = self.depth().unwrap_or_default();
        View { width: of(&self.width), height: of(&self.height), depth, ..View::default() }
    }

    fn of_file(&self, path: &Path, kernel: Option<&OsStr>) -> Result<FromFile, OpticsError> {
        let (file, input) = TableFile::read(path)?;
        let optics = Optics::paper_lens_for(file.tables.geometry())?;
        Ok((optics::choose(Some((path, file)), optics, kernel)?, Some(input)))
    }

    fn of_lens(&self, path: &Path, kernel: Option<&OsStr>) -> Result<FromFile, OpticsError> {
        let by = self.rows_by(TablesBy::Fitting);
        Ok((optics::choose(None, Optics::of_file(path, &self.view(), by)?, kernel)?, None))
    }

    fn of_radius(&self, kernel: Option<&OsStr>) -> Result<FromFile, OpticsError> {
        let radius = self.radius.as_ref().map(|radius| *radius.get_ref());
        let lens = radius.map_or_else(|| Ok(Equidistant::default()), Equidistant::from_radius)?;
        let by = self.rows_by(TablesBy::Equation9);
        Ok((optics::choose(None, Optics::of_equidistant(lens, &self.view(), by)?, kernel)?, None))
    }

    fn rows_by(&self, otherwise: TablesBy) -> TablesBy {
        match self.rows {
            Some(RowsText::Fitted) => TablesBy::Fitting,
            Some(RowsText::Equation9) => TablesBy::Equation9,
            None => otherwise,
        }
    }
}

/// The kernel's name, or its file's path.
fn kernel(name: &Spanned<String>, files: &Files) -> Result<PathBuf, Fault> {
    use halfrow::kernels::NamedKernel;
    if name.get_ref().parse::<NamedKernel>().is_ok() {
        return Ok(PathBuf::from(name.get_ref()));
    }
    files.find(name)
}

/// The frames with these names: `builtin:NAME`, or files, which must have the size of the tables.
pub(super) fn frames(
    names: &[Spanned<String>],
    geometry: &Geometry,
    phase: Phase,
    files: &mut Files,
) -> Result<Vec<FrameSource>, Fault> {
    let size = PictureSize::Exactly(geometry.width(), geometry.height());
    let how = ReadOptions { depth: geometry.depth(), phase, size, ..ReadOptions::default() };
    let source = |name: &Spanned<String>| match Builtin::named(name.get_ref()) {
        Ok(Some(builtin)) => Ok(FrameSource::Builtin(builtin)),
        Ok(None) => of_file(name, &how, geometry, files),
        Err(error) => Err(Fault::input(name, format!("`{}`", name.get_ref()), error)),
    };
    names.iter().map(source).collect()
}

fn of_file(
    name: &Spanned<String>,
    how: &ReadOptions,
    geometry: &Geometry,
    files: &mut Files,
) -> Result<FrameSource, Fault> {
    let path = files.find(name)?;
    let read = FrameFile::read(&path).and_then(|file| Ok((file.decode(how)?.frame, file)));
    let what = || format!("the frame {}", path.display());
    let (frame, file) = read.map_err(|error| Fault::input(name, what(), error))?;
    files.note(name, Input::of_bytes(&path, file.bytes()))?;
    check_size(&path, (frame.width(), frame.height()), how, geometry)
        .map_err(|error| Fault::input(name, what(), error))?;
    Ok(FrameSource::File { path, frame: Arc::new(frame) })
}
