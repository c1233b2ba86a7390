//! The frames of a raw run as bars: how fast Lancer is as a multiple of Embree, by scene and by directions.

use crate::Failure;
use crate::record::Ratio;
use serde::Deserialize;
use std::path::Path;

/// A raw run, as far as its frames go.
#[derive(Deserialize)]
struct Run {
    machine: String,
    rows: Vec<serde_json::Value>,
}

/// A row of the table of frames.
#[derive(Deserialize)]
struct Frame {
    scene: String,
    directions: u32,
    threads: usize,
    lancer_seconds: Vec<f64>,
    embree_seconds: Vec<f64>,
}

impl Frame {
    /// Embree's time to Lancer's.
    fn ratio(&self) -> Ratio {
        Ratio::of(&self.embree_seconds, &self.lancer_seconds)
    }
}

/// Draws the frames on one thread of the raw run in `run` into the SVG file `output`.
pub(crate) fn draw(run: &Path, output: &Path) -> Result<(), Failure> {
    let run: Run = serde_json::from_str(&std::fs::read_to_string(run)?)?;
    let mut frames = Vec::new();
    for row in run.rows.into_iter().filter(|row| row["table"] == "frames") {
        frames.push(serde_json::from_value::<Frame>(row)?);
    }
    frames.retain(|frame| frame.threads == 1);
    if frames.is_empty() {
        return Err(
            "the run holds no frames on one thread: make one with embree --tables frames --raw".into()
        );
    }
    Ok(std::fs::write(output, svg(&frames, &run.machine))?)
}

const WIDTH: f64 = 720.0;
const HEIGHT: f64 = 400.0;
const LEFT: f64 = 60.0;
const RIGHT: f64 = 20.0;
const TOP: f64 = 76.0;
const BOTTOM: f64 = 60.0;

/// What bars of one number of directions look like.
const COLORS: [&str; 4] = ["#8fb8de", "#3b7dd8", "#0b3c75", "#c0392b"];

fn svg(frames: &[Frame], machine: &str) -> String {
    let mut scenes: Vec<&str> = frames.iter().map(|frame| frame.scene.as_str()).collect();
    scenes.dedup();
    let mut directions: Vec<u32> = frames.iter().map(|frame| frame.directions).collect();
    directions.sort_unstable();
    directions.dedup();
    let most = frames.iter().map(|frame| frame.ratio().most).fold(1.0, f64::max);
    let top = (most * 4.0).ceil() / 4.0;
    let place_y = |ratio: f64| HEIGHT - BOTTOM - ratio / top * (HEIGHT - BOTTOM - TOP);
    let mut svg = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {WIDTH} {HEIGHT}' font-family='sans-serif' \
         font-size='13'>\n<rect width='{WIDTH}' height='{HEIGHT}' fill='white'/>\n"
    );
    let mut line = |text: String| svg += &(text + "\n");
    let middle = WIDTH / 2.0;
    line(format!(
        "<text x='{middle}' y='26' text-anchor='middle' font-size='16' font-weight='bold'>Speed of a frame, Embree = 1</text>"
    ));
    line(format!(
        "<text x='{middle}' y='{}' text-anchor='middle' fill='#555555'>1024 x 768, two shadow rays a point; one thread of an \
         {machine}; median, least and most of the turns</text>",
        HEIGHT - 14.0
    ));
    for (index, directions) in directions.iter().enumerate() {
        let (x, color) = (LEFT + 8.0 + 215.0 * index as f64, COLORS[index % COLORS.len()]);
        let name = match directions {
            0 => "no ambient occlusion".to_owned(),
            n => format!("{n} directions, {} traced", n / 2),
        };
        line(format!("<rect x='{x}' y='44' width='12' height='12' fill='{color}'/>"));
        line(format!("<text x='{}' y='55'>{name}</text>", x + 18.0));
    }
    for step in 0..=(top * 4.0) as u32 {
        let ratio = f64::from(step) / 4.0;
        let (y, color) = (place_y(ratio), if step == 4 { "#333333" } else { "#dddddd" });
        line(format!("<line x1='{LEFT}' y1='{y:.1}' x2='{}' y2='{y:.1}' stroke='{color}'/>", WIDTH - RIGHT));
        line(format!("<text x='{}' y='{:.1}' text-anchor='end'>{ratio}</text>", LEFT - 8.0, y + 4.0));
    }
    let group = (WIDTH - LEFT - RIGHT) / scenes.len() as f64;
    let bar = 0.8 * group / directions.len() as f64;
    for (place, scene) in scenes.iter().enumerate() {
        let start = LEFT + group * (place as f64 + 0.1);
        let y = HEIGHT - BOTTOM + 20.0;
        line(format!("<text x='{:.1}' y='{y}' text-anchor='middle'>{scene}</text>", start + 0.4 * group));
        for frame in frames.iter().filter(|frame| frame.scene == *scene) {
            let column = directions.iter().position(|&n| n == frame.directions).unwrap_or(0);
            let ratio = frame.ratio();
            let (x, y) = (start + bar * column as f64, place_y(ratio.median));
            let (height, color) = (place_y(0.0) - y, COLORS[column % COLORS.len()]);
            line(format!(
                "<rect x='{x:.1}' y='{y:.1}' width='{:.1}' height='{height:.1}' fill='{color}'/>",
                bar - 3.0
            ));
            let (x, low, high) = (x + 0.5 * (bar - 3.0), place_y(ratio.least), place_y(ratio.most));
            line(format!(
                "<line x1='{x:.1}' y1='{low:.1}' x2='{x:.1}' y2='{high:.1}' stroke='black' stroke-opacity='0.5'/>"
            ));
            line(format!(
                "<text x='{x:.1}' y='{:.1}' text-anchor='middle' font-size='11'>{:.2}</text>",
                high - 5.0,
                ratio.median
            ));
        }
    }
    svg.push_str("</svg>\n");
    svg
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(scene: &str, directions: u32, embree_seconds: f64) -> Frame {
        let (lancer_seconds, embree_seconds) = (vec![1.0; 3], vec![embree_seconds; 3]);
        Frame { scene: scene.into(), directions, threads: 1, lancer_seconds, embree_seconds }
    }

    #[test]
    fn each_frame_has_a_bar_as_high_as_its_ratio() {
        let drawn =
            svg(&[frame("bunny", 0, 0.5), frame("bunny", 128, 1.25), frame("dragon", 0, 0.25)], "processor");
        let heights: Vec<f64> = drawn
            .lines()
            .filter(|line| line.starts_with("<rect") && line.contains("height='") && line.contains('.'))
            .filter_map(|line| line.split("height='").nth(1)?.split('\'').next()?.parse().ok())
            .collect();
        let [half, five_quarters, quarter] = heights[..] else { panic!("{heights:?}") };
        assert!(
            (five_quarters / half - 2.5).abs() < 0.01 && (quarter / half - 0.5).abs() < 0.01,
            "{heights:?}"
        );
        assert_eq!(drawn.matches("dragon").count(), 1);
        assert!(drawn.contains("128 directions, 64 traced"));
    }
}
