//! Which sheet of a spreadsheet is read: the one that can be.

use super::error::{Candidate, ImportError};
use super::mapping::Mapping;
use super::preview::Preview;
use super::roles;
use super::source::Source;

/// What was read, with its preview.
pub(super) trait Read {
    fn preview(&mut self) -> &mut Preview;
}

impl Read for super::LoopFile {
    fn preview(&mut self) -> &mut Preview {
        &mut self.preview
    }
}

impl Read for super::ScanFile {
    fn preview(&mut self) -> &mut Preview {
        &mut self.preview
    }
}

/// The reading of the only sheet that can be read.
///
/// # Errors
/// That of the only sheet, of the first with rows of numbers if none can be read; or the choice among several.
pub(super) fn one_of<T: Read>(
    sources: &[Source<'_>],
    mapping: &Mapping,
    proceed: &dyn Fn() -> bool,
    read: impl Fn(&Source<'_>) -> Result<T, ImportError>,
) -> Result<T, ImportError> {
    let mut found: Vec<(usize, T)> = Vec::new();
    let mut error: Option<ImportError> = None;
    for (index, source) in sources.iter().enumerate() {
        proceed().then_some(()).ok_or_else(ImportError::stopped)?;
        match read(source) {
            Ok(file) => found.push((index, file)),
            Err(fault) if sources.len() == 1 || fault.is_stopped => return Err(fault),
            Err(mut fault) => {
                if let Some((name, number, _)) = &source.sheet {
                    fault.fault = format!("{} (sheet `{name}`)", fault.fault);
                    for candidate in &mut fault.candidates {
                        candidate.mapping = format!("{};sheet:{number}", candidate.mapping);
                    }
                }
                // What can be settled says more than that there is nothing.
                let says = |error: &ImportError| {
                    (!error.candidates.is_empty(), error.line.is_some() || error.unknown_unit.is_some())
                };
                if error.as_ref().is_none_or(|other| says(&fault) > says(other)) {
                    error = Some(fault);
                }
            }
        }
    }
    if found.len() > 1 {
        let of = |(index, file): &mut (usize, T)| {
            let (name, number, _) = sources[*index].sheet.clone().unwrap_or_default();
            let rows = file.preview().rows;
            let values = vec![format!("{rows} rows")];
            Candidate {
                quantity: "sheet",
                column: None,
                name,
                values,
                mapping: roles::base(mapping, &[], &format!("sheet:{number}")),
            }
        };
        let candidates: Vec<Candidate> = found.iter_mut().map(of).collect();
        let names: Vec<String> = candidates.iter().map(|one| format!("`{}`", one.name)).collect();
        let fault = format!("{} sheets can be read, {}: choose one by `sheet`", names.len(), names.join(", "));
        return Err(ImportError::ambiguous(fault, candidates));
    }
    let Some((index, mut file)) = found.pop() else {
        return Err(error.unwrap_or_else(|| ImportError::of_file("there are no sheets")));
    };
    if let Some((name, number, count)) = sources[index].sheet.as_ref().filter(|(.., count)| *count > 1) {
        let remark = format!("Sheet `{name}`, {number} of {count}: choose another one by `sheet`.");
        if sources.len() > 1 {
            file.preview().assumed.push(format!("The sheet is `{name}`, the only one of {count} that can be read so."));
        }
        file.preview().reading.push(remark);
    }
    Ok(file)
}
