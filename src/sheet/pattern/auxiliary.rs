//! Auxiliary lines that bound no face.

use super::line::PatternLine;
use super::piece::SegmentPiece;
use crate::math::pieces::pieces;
use std::collections::HashSet;

/// Returns the pieces between `points` points without auxiliary ones that end where nothing else is, or that no line
/// joins to a crease or the rim; and the number of lines of which a piece is left out.
pub(super) fn without_loose(
    lines: &[PatternLine],
    points: usize,
    pieces: Vec<SegmentPiece>,
) -> (Vec<SegmentPiece>, usize) {
    let mut at: Vec<Vec<usize>> = vec![Vec::new(); points];
    for (number, piece) in pieces.iter().enumerate() {
        piece.ends.iter().for_each(|&v| at[v].push(number));
    }
    let mut kept = without_islands(lines, points, &pieces);
    let mut degree: Vec<usize> = at.iter().map(|here| here.iter().filter(|&&number| kept[number]).count()).collect();
    let mut ends: Vec<usize> = (0..points).filter(|&v| degree[v] == 1).collect();
    while let Some(v) = ends.pop() {
        let last = at[v].iter().copied().find(|&number| kept[number]);
        let Some(number) = last.filter(|&number| lines[pieces[number].segment].auxiliary) else { continue };
        kept[number] = false;
        for end in pieces[number].ends {
            degree[end] -= 1;
            if degree[end] == 1 {
                ends.push(end);
            }
        }
    }
    let mut shortened: Vec<usize> =
        pieces.iter().zip(&kept).filter(|(_, kept)| !**kept).map(|(piece, _)| piece.segment).collect();
    shortened.dedup();
    let left = pieces.into_iter().zip(kept).filter_map(|(piece, kept)| kept.then_some(piece)).collect();
    (if shortened.is_empty() { left } else { rejoined(points, left) }, shortened.len())
}

/// Returns the pieces with those parts of one line joined again between which nothing else is left.
fn rejoined(points: usize, pieces: Vec<SegmentPiece>) -> Vec<SegmentPiece> {
    let mut degree = vec![0; points];
    pieces.iter().flat_map(|piece| piece.ends).for_each(|v| degree[v] += 1);
    let mut joined: Vec<SegmentPiece> = Vec::with_capacity(pieces.len());
    for piece in pieces {
        match joined.last_mut() {
            Some(last)
                if last.segment == piece.segment && last.ends[1] == piece.ends[0] && degree[piece.ends[0]] == 2 =>
            {
                last.ends[1] = piece.ends[1];
            }
            _ => joined.push(piece),
        }
    }
    joined
}

/// Returns which pieces are joined, by lines of any kind, to one that is not auxiliary; all are if there is none of
/// these.
fn without_islands(lines: &[PatternLine], points: usize, all: &[SegmentPiece]) -> Vec<bool> {
    let drawn = all.iter().filter(|piece| !lines[piece.segment].auxiliary).map(|piece| piece.ends[0]);
    let ends = all.iter().map(|piece| piece.ends);
    let joined: HashSet<usize> = pieces(points, ends, drawn).into_iter().flatten().collect();
    all.iter().map(|piece| joined.is_empty() || joined.contains(&piece.ends[0])).collect()
}
