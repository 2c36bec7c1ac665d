//! `tread gap import`: a labelled campaign, written as a laboratory would have it, comes back as it was.
#![cfg(feature = "cli")]

use std::path::{Path, PathBuf};

use tread_block::error::Fault;
use tread_block::gap::campaign::{Campaign, CHANNELS};
use tread_block::gap::import::{import, told::Imported};

/// Rows before the road starts, and when it does in the logger's time [ms].
const BEFORE: usize = 60;
const START: f64 = 112.5;

/// Column, unit, and what one count is worth in SI.
const COLUMNS: [(&str, &str, f64); 5] = [
    ("Fx", "kN", 1e3),
    ("Fz", "kN", 1e3),
    ("vib", "mm/s", 1e-3),
    ("edge", "\u{b5}m", 1e-6),
    ("lift", "mm", 1e-3),
];

fn original() -> Campaign {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    Campaign::load(&root.join("tests/data/campaigns/open/open-05.zip")).unwrap()
}

/// A laboratory's folder with its files and a plan.
struct Laboratory(PathBuf);

impl Laboratory {
    /// Semicolons, decimal commas, Latin-1, a line before the header, milliseconds.
    fn new(name: &str, campaign: &Campaign) -> Self {
        let folder =
            std::env::temp_dir().join(format!("tread-import-{}-{name}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        for run in &campaign.runs {
            let header: Vec<String> =
                COLUMNS.iter().map(|(c, unit, _)| format!("{c} [{unit}]")).collect();
            let mut text = format!("Rig 4\nt [ms];{};note\n", header.join(";"));
            let step = 1e3 / campaign.plan.sampling_rate;
            let first = run.record.channel.each_ref().map(|c| c.as_ref().map_or(0.0, |c| c[0]));
            for row in 0..BEFORE + run.record.time.len() {
                let at = row.checked_sub(BEFORE);
                let time = at.map_or_else(
                    || START - (BEFORE - row) as f64 * step,
                    |at| START + 1e3 * run.record.time[at],
                );
                text.push_str(&format!("{time:.5}"));
                for (c, (_, _, scale)) in COLUMNS.iter().enumerate() {
                    let channel = run.record.channel[c].as_ref();
                    let value = match at {
                        Some(at) => channel.map_or(0.0, |c| c[at]),
                        None => first[c],
                    };
                    text.push_str(&format!(";{:.9}", value / scale));
                }
                text.push_str(";7\n");
            }
            let latin_1: Vec<u8> = text.replace('.', ",").chars().map(|c| c as u8).collect();
            std::fs::write(folder.join(Self::file(&run.spec.file)), latin_1).unwrap();
        }
        let this = Self(folder);
        this.plan(|plan| plan);
        this
    }

    fn file(run: &str) -> String {
        run.replace("runs/", "rig-")
    }

    /// The plan: the campaign's own file with where things come from; `change` may spoil it.
    fn plan(&self, change: impl Fn(String) -> String) {
        let source = tread_block::gap::packed::Source::open(
            &Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/campaigns/open/open-05.zip"),
        );
        let text = String::from_utf8(source.unwrap().bytes("campaign.toml").unwrap()).unwrap();
        let mut text = text.replace("tread-block-campaign/1", "tread-block-import/1");
        text = text.replace(
            "[block]",
            "[source]\ndelimiter = \";\"\ndecimal = \",\"\nskip_lines = 1\n[block]",
        );
        text = text.replace("sampling_rate_hz", "time = { column = \"t\" }\nsampling_rate_hz");
        for (channel, (column, ..)) in CHANNELS.iter().zip(COLUMNS) {
            text = text.replace(
                &format!("{channel} = {{"),
                &format!("{channel} = {{ column = \"{column}\","),
            );
        }
        let lines = text.lines().map(|line| match line.strip_prefix("file = ") {
            Some(file) => format!("{line}\nfrom = {}\nstart = \"{START} ms\"", Self::file(file)),
            None => line.to_string(),
        });
        let text = lines.collect::<Vec<_>>().join("\n");
        std::fs::write(self.0.join("plan.toml"), change(text)).unwrap();
    }

    fn import(&self) -> Result<Imported, Fault> {
        import(&self.0.join("plan.toml"), &self.0.join("campaign"))
    }

    /// Messages of an import that must fail and leave nothing behind.
    fn refused(&self) -> String {
        let message = self.import().unwrap_err().to_string();
        assert!(!self.0.join("campaign").exists(), "something was written");
        message
    }
}

impl Drop for Laboratory {
    fn drop(&mut self) {
        _ = std::fs::remove_dir_all(&self.0);
    }
}

#[test]
fn a_campaign_in_a_laboratorys_units_comes_back_as_it_was() {
    let truth = original();
    let laboratory = Laboratory::new("back", &truth);
    let told = laboratory.import().unwrap();
    let got = Campaign::load(&laboratory.0.join("campaign")).unwrap();
    assert_eq!(got.warnings, vec![], "the diagnosis would complain");
    assert_eq!(got.plan, truth.plan);
    assert_eq!(got.runs.len(), truth.runs.len());
    for (got, truth) in got.runs.iter().zip(&truth.runs) {
        for (c, (_, _, scale)) in COLUMNS.iter().enumerate() {
            let (Some(a), Some(b)) = (&got.record.channel[c], &truth.record.channel[c]) else {
                // A ring-down keeps its edge velocity only.
                assert!(c != 2 && truth.spec.file.contains("ringdown"), "{}", truth.spec.file);
                continue;
            };
            assert_eq!(a.len(), b.len(), "{}", truth.spec.file);
            // The laboratory's files have nine decimals of their unit.
            let worst = a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(worst <= 1e-9 * scale, "{} {}: {worst}", truth.spec.file, CHANNELS[c]);
        }
    }
    // Every channel was copied, from 112.5 ms on, and the file says so.
    let channels = told.runs.iter().flat_map(|r| &r.channels);
    assert!(channels.clone().all(|c| c.copied && (c.shift - 1e-3 * START).abs() < 1e-12));
    assert!(told.table().contains("Latin-1") && told.table().contains("no channel uses: note"));
    assert!(laboratory.0.join("campaign/import.json").exists());
}

#[test]
fn a_delay_moves_one_channel_and_a_sign_turns_it() {
    let truth = original();
    let laboratory = Laboratory::new("delay", &truth);
    laboratory.plan(|plan| {
        // The last two rows would be in the record no more.
        plan.replace("duration_s = 0.024", "duration_s = 0.0238")
            .replace("duration_s = 0.008", "duration_s = 0.0078")
            .replace(
                "column = \"vib\",",
                "column = \"vib\", unit = \"-1 mm/s\", delay = \"80 us\",",
            )
    });
    laboratory.import().unwrap();
    let got = Campaign::load(&laboratory.0.join("campaign")).unwrap();
    // 80 µs are two rows at 25 kHz.
    let velocity = |c: &Campaign| c.runs[3].record.channel[2].clone().unwrap();
    let (got, truth) = (velocity(&got), velocity(&truth));
    // Rows 0 to 595 of 23.8 ms at 40 µs.
    assert_eq!(got.len(), 596);
    let worst = got.iter().zip(&truth[2..]).map(|(a, b)| (a + b).abs()).fold(0.0, f64::max);
    assert!(worst < 1e-9, "{worst}");
}

#[test]
fn what_cannot_be_told_is_refused_all_at_once_and_nothing_is_written() {
    let truth = original();
    let laboratory = Laboratory::new("refused", &truth);
    laboratory.plan(|plan| {
        plan.replace("column = \"Fx\",", "column = \"Fx\", unit = \"V\",")
            .replace("\"edge\"", "\"edg\"")
            .replace("\"lift\"", "\"lift_2\"")
            .replace("column = \"Fz\",", "column = \"Fz\", unit = \"N\",")
    });
    let path = laboratory.0.join("rig-03-v300.csv");
    let text: String = std::fs::read(&path).unwrap().iter().map(|b| char::from(*b)).collect();
    let mut lines: Vec<&str> = text.lines().collect();
    lines.remove(200);
    lines.insert(300, lines[300]);
    std::fs::write(&path, lines.join("\n").replace('\u{b5}', "u")).unwrap();
    let message = laboratory.refused();
    for part in [
        "unit of Fx = \"V\"",
        "no column \"edg\"",
        "no column \"lift_2\"",
        "worth 1, against 1000 in the header",
        "rig-03-v300.csv: t = 1 times twice",
    ] {
        assert!(message.contains(part), "{part} is not in:\n{message}");
    }
}

#[test]
fn a_plan_tells_all_its_problems_at_once() {
    let laboratory = Laboratory::new("plan", &original());
    laboratory.plan(|plan| {
        plan.replace("tread-block-import/1", "x/1")
            .replace("[rig]", "[rigg]")
            .replace("noise_std = 0.002", "noise_std = \"2 kN\"")
            .replacen("start = \"112.5 ms\"", "", 1)
            .replacen("start = \"112.5 ms\"", "start = \"soon\"", 1)
    });
    let message = laboratory.refused();
    for part in
        ["format = x/1", "rig = missing", "rigg", "noise_std", "start = missing", "\"soon\""]
    {
        assert!(message.contains(part), "{part} is not in:\n{message}");
    }
}

#[test]
fn a_level_of_a_column_starts_the_runs() {
    let laboratory = Laboratory::new("trigger", &original());
    let mut rows = String::from("t [ms],Fx [N],road [mm/s],vib [mm/s]\n");
    // The road stands until 20 ms and then gains 10 mm/s per 10 µs row: 5 mm/s is passed at 20.005 ms.
    for row in 0..6000_u32 {
        let t = 0.01 * f64::from(row);
        let road = (1e3 * (t - 20.0)).max(0.0);
        let wave = (6.0 * t).sin();
        rows.push_str(&format!("{t:.2},{},{road:.3},{}\n", 30.0 + 5.0 * wave, 100.0 * wave));
    }
    std::fs::write(laboratory.0.join("road.csv"), rows).unwrap();
    laboratory.plan(|plan| {
        let head = plan.split("[[runs]]").next().unwrap().to_string();
        let head = head.split("normal_force_n").next().unwrap().to_string()
            + "edge_velocity_m_s = { column = \"vib\", noise_std = 0 }\n[nominal]"
            + head.split("[nominal]").nth(1).unwrap();
        let head = head.replace("delimiter = \";\"\ndecimal = \",\"\nskip_lines = 1\n", "");
        let start = "[start]\ncolumn = \"road\"\nabove = 5\n";
        let run = "[[runs]]\nfrom = \"road.csv\"\nkind = \"sliding\"\nroad_speed_m_s = 0.3\n\
                   mean_pressure_pa = 250e3\nduration_s = 0.024\n";
        format!("{head}{start}{run}")
    });
    let told = laboratory.import().unwrap();
    let channel = &told.runs[0].channels[0];
    assert!((channel.shift - 0.020_005).abs() < 1e-9, "{}", channel.shift);
    // 100 kHz between the rows of 25 kHz: splined, and a wave of 1 kHz loses next to nothing.
    assert!(!channel.copied && channel.lost < 0.01, "{channel:?}");
}

#[test]
fn the_plan_of_the_book_is_a_good_one() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/src/own-campaign.md");
    let page = std::fs::read_to_string(page).unwrap();
    let plan = page.split("```toml\n").nth(1).unwrap().split("```").next().unwrap();
    let plan = tread_block::gap::import::plan::parse(plan, "the book").unwrap();
    // The names of the datasheet are those of a campaign that the diagnosis knows.
    let names =
        |t: &toml::Table| t["nominal"].as_table().unwrap().keys().cloned().collect::<Vec<_>>();
    assert_eq!(names(&plan.campaign), original().plan.nominal.into_keys().collect::<Vec<_>>());
    assert_eq!((plan.channels.len(), plan.runs.len()), (4, 2));
}
