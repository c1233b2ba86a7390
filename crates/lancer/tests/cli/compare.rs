//! `lancer compare`: numbers, thresholds and the picture of the differences.

use crate::sandbox::{Sandbox, read_png, text};

#[test]
fn a_picture_is_no_way_apart_from_itself_in_any_lossless_format() {
    let sandbox = Sandbox::new();
    for name in ["a.png", "a.webp", "a.tif"] {
        sandbox.ok(&format!("render scene.yaml -o {name}"));
        let told = sandbox.json(&format!("compare {name} a.png --json --threshold 0"));
        assert_eq!((told["differing"].as_u64(), told["flip"].as_f64()), (Some(0), Some(0.0)), "{name}");
        assert_eq!((told["max"].as_f64(), &told["psnr"]), (Some(0.0), &serde_json::Value::Null));
    }
    for name in ["b.exr", "b.pfm", "b.tif"] {
        let bits = if name == "b.tif" { "--bits 32" } else { "" };
        sandbox.ok(&format!("render scene.yaml -o {name} {bits}"));
        let told = sandbox.json(&format!("compare {name} b.exr --json"));
        assert_eq!((told["differing"].as_u64(), &told["linear"]), (Some(0), &true.into()), "{name}");
    }
    let told = text(&sandbox.ok("compare a.png b.exr").stdout);
    assert!(told.contains("flip") && told.contains("sRGB"), "{told}");
}

#[test]
fn the_exit_code_says_whether_the_threshold_holds() {
    let sandbox = Sandbox::new();
    sandbox.ok("render scene.yaml -o a.png");
    sandbox.ok("render scene.yaml -o b.png --exposure 0.5");
    let told = sandbox.json("compare a.png b.png --json");
    for metric in ["mean", "rmse", "max", "flip"] {
        let value = told[metric].as_f64().unwrap();
        assert!(value > 0.0 && value <= 1.0, "{metric}");
        sandbox.ok(&format!("compare a.png b.png --metric {metric} --threshold {}", value * 1.001));
        let line = format!("compare a.png b.png --metric {metric} --threshold {}", value * 0.999);
        assert_eq!(sandbox.lancer(line.split_whitespace()).output().unwrap().status.code(), Some(1));
    }
    let psnr = told["psnr"].as_f64().unwrap();
    assert!((psnr + 20.0 * told["rmse"].as_f64().unwrap().log10()).abs() < 1e-9);
    sandbox.ok(&format!("compare a.png b.png --metric psnr --threshold {}", psnr - 0.01));
    let line = format!("compare a.png b.png --metric psnr --threshold {}", psnr + 0.01);
    assert_eq!(sandbox.lancer(line.split_whitespace()).output().unwrap().status.code(), Some(1));
}

#[test]
fn the_drawing_is_black_where_nothing_differs() {
    let sandbox = Sandbox::new();
    sandbox.ok("render scene.yaml -o a.png");
    sandbox.ok("render scene.yaml -o b.png --set materials.mirror.diffuse=0.9");
    let (a, b) = (read_png(&sandbox.path("a.png")), read_png(&sandbox.path("b.png")));
    sandbox.ok("compare a.png b.png --metric max --amplify 1 -o d.png");
    let drawn = read_png(&sandbox.path("d.png"));
    for ((a, b), drawn) in a.pixels.iter().zip(&b.pixels).zip(&drawn.pixels) {
        assert_eq!(*drawn, std::array::from_fn(|i| a[i].abs_diff(b[i])));
    }
    sandbox.ok("compare a.png a.png -o flip.png");
    assert!(read_png(&sandbox.path("flip.png")).pixels.iter().all(|pixel| *pixel == [0, 0, 4]));
}

#[test]
fn what_cannot_be_compared_is_told() {
    let sandbox = Sandbox::new();
    sandbox.ok("render scene.yaml -o a.png");
    sandbox.ok("render scene.yaml -o b.png --width 25");
    assert!(
        sandbox.fails(3, "compare a.png b.png").contains("24 x 16 pixels cannot be compared with 25 x 16")
    );
    assert!(sandbox.fails(3, "compare a.png scene.yaml").contains("not an image"));
    assert!(sandbox.fails(3, "compare a.png nothing.png").contains("nothing.png"));
    assert!(sandbox.fails(2, "compare a.png b.png -o d.gif").contains(".png"));
    sandbox.fails(2, "compare a.png b.png --pixels-per-degree 0");
}
