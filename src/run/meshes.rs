//! The formats of mesh files, recognised by the endings of their names.

use std::path::Path;

use super::convert;
use super::error::RunError;
use crate::output::picture::Picture;
use crate::output::{files, glb, vtk};
use crate::sheet::pattern::{self, Cleanup, Format};
use crate::sheet::{Sheet, build, fold, obj, ply, stl, thickened};

/// Endings of meshes that are read.
pub(super) const READ: &str = ".fold, .obj, .stl, .vtu, .svg, .cp, .opx, .ori or .dxf";
/// Endings of meshes and scenes.
pub(super) const READ_OR_SCENE: &str = ".fold, .obj, .stl, .vtu, .svg, .cp, .opx, .ori, .dxf or .toml";
/// Endings of meshes that are written.
const WRITTEN: &str = ".fold, .obj, .vtu, .stl, .ply, .glb, .svg, .cp or .dxf";
/// Endings of states that are written.
const STATES: &str = ".vtu, .stl, .ply, .obj, .fold or .glb";
/// Endings of flat crease patterns that can be cleaned.
pub(super) const CLEANED: &str = ".fold, .svg, .cp, .opx, .ori or .dxf";

/// Part of a thickness below which it is said that walls are thinner.
const THINNER: f64 = 0.995;

/// The kinds of files that hold a mesh.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum MeshKind {
    Fold,
    Obj,
    Stl,
    Vtu,
    Lines(Format),
}

/// Returns the ending of a file name in lower case; empty if it has none.
pub(super) fn ending(path: &Path) -> String {
    path.extension().unwrap_or_default().to_string_lossy().to_lowercase()
}

impl MeshKind {
    pub(super) fn of(path: &Path) -> Option<Self> {
        match ending(path).as_str() {
            "fold" => Some(Self::Fold),
            "obj" => Some(Self::Obj),
            "stl" => Some(Self::Stl),
            "vtu" => Some(Self::Vtu),
            _ => Format::of(path).map(Self::Lines),
        }
    }
}

/// Reads a mesh, or a flat crease pattern that is cleaned up; `expected` are the endings that messages name.
pub(super) fn read_mesh(
    path: &Path,
    frame: Option<usize>,
    cleanup: Option<&Cleanup>,
    expected: &'static str,
) -> Result<Sheet, RunError> {
    match (MeshKind::of(path), frame, cleanup) {
        (Some(MeshKind::Fold), ..) => Ok(fold::read_frame(path, frame, cleanup)?),
        (Some(_), Some(frame), _) => Err(RunError::NoFrames { path: path.into(), frame }),
        (Some(MeshKind::Lines(format)), ..) => Ok(pattern::read(path, format, cleanup.unwrap_or(&Cleanup::default()))?),
        (Some(MeshKind::Obj), _, None) => Ok(obj::read(path)?),
        (Some(MeshKind::Stl), _, None) => Ok(stl::read(path)?),
        (Some(MeshKind::Vtu), _, None) => {
            let title = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            let drawn = convert::drawing(vtk::read_vtu(path)?, title);
            build::build(&drawn).map_err(|defect| RunError::NoSheet { path: path.into(), defect })
        }
        _ => Err(RunError::Ending { path: path.into(), ending: ending(path), expected }),
    }
}

/// Writes a sheet, or the solid that it is with a thickness, into a file of the format of its ending. Returns a
/// sentence for each part of the sheet that the file does not keep.
///
/// # Errors
/// [`RunError`] if the ending is unknown, if the file cannot be written, if it is for flat sheets and the sheet is not
/// flat, and if the thickness is not above 0.
pub fn write_sheet(sheet: &Sheet, to: &Path, thickness: Option<f64>) -> Result<Vec<String>, RunError> {
    let Some(thickness) = thickness else { return write_thin(sheet, to) };
    if !(thickness > 0.0 && thickness.is_finite()) {
        return Err(RunError::Thickness { path: to.into(), thickness });
    }
    let solid = thickened(sheet, thickness).map_err(|defect| RunError::NoSolid { path: to.into(), defect })?;
    let mut notes = write_thin(&solid.surface, to)?;
    if solid.thinnest < THINNER {
        notes.push(format!(
            "the thickness is not kept everywhere: walls are as thin as {:.2} of it beside sharp corners",
            solid.thinnest
        ));
    }
    Ok(notes)
}

fn write_thin(sheet: &Sheet, to: &Path) -> Result<Vec<String>, RunError> {
    let refused = |reason| RunError::NotFlat { path: to.into(), reason };
    let mut changed = 0;
    match ending(to).as_str() {
        "fold" => files::write(to, fold::write(sheet))?,
        "obj" => files::write(to, obj::write(sheet))?,
        "vtu" => vtk::write_vtu(to, &Picture::drawn(sheet))?,
        "stl" => files::write(to, stl::write(sheet))?,
        "ply" => files::write(to, ply::write(sheet))?,
        "glb" => files::write(to, glb::bytes(&Picture::drawn(sheet)))?,
        "svg" => files::write(to, pattern::write_svg(sheet).map_err(refused)?)?,
        "cp" => {
            let (text, others) = pattern::write_cp(sheet).map_err(refused)?;
            changed = others;
            files::write(to, text)?;
        }
        "dxf" => files::write(to, pattern::write_dxf(sheet).map_err(refused)?)?,
        ending => return Err(RunError::Ending { path: to.into(), ending: ending.into(), expected: WRITTEN }),
    }
    let mut notes = convert::not_kept(sheet, &ending(to));
    if changed > 0 {
        notes.push(format!("CP has no hinges, facets and joints: {changed} lines are written as auxiliary"));
    }
    Ok(notes)
}

/// Writes a state into a file of the format of its ending: `.vtu`, `.stl`, `.ply`, `.obj`, `.fold` or `.glb`.
/// Where a thickness is given, writes the solid of the sheet instead ([`thickened`]). Returns a sentence for each part of
/// the sheet that the file does not keep.
///
/// # Errors
/// [`RunError`] if the ending is another one, if the file cannot be written, if the state is no sheet for STL, PLY, OBJ
/// and FOLD: a face has no area, for instance; and if the thickness is not above 0.
pub fn write_state(picture: &Picture, to: &Path, thickness: Option<f64>) -> Result<Vec<String>, RunError> {
    match (ending(to).as_str(), thickness) {
        ("vtu", None) => vtk::write_vtu(to, picture)?,
        ("glb", None) => files::write(to, glb::bytes(picture))?,
        ("vtu" | "glb" | "stl" | "ply" | "obj" | "fold", _) => {
            let title = to.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            let sheet = build::build(&convert::drawing(convert::mesh(picture.clone()), title));
            let sheet = sheet.map_err(|defect| RunError::NoSheet { path: to.into(), defect })?;
            return write_sheet(&sheet, to, thickness);
        }
        (ending, _) => return Err(RunError::Ending { path: to.into(), ending: ending.into(), expected: STATES }),
    }
    Ok(vec![])
}
