//! Displacements of mesh nodes as CSV: `tread simulate --field`.

use std::io::Write;
use std::path::PathBuf;

use super::output::{self, Stop};
use crate::block::TreadBlock;
use crate::error::{Fault, Problem};

/// What was typed.
#[derive(Debug, clap::Args)]
#[group(skip)]
pub struct Arguments {
    /// Also write displacements of mesh nodes to this CSV: time, node, x from the block's middle, z above
    /// the tread face, displacements ux, uz relative to the clamped face [s, m]
    #[arg(long = "field", value_name = "FILE")]
    file: Option<PathBuf>,
    /// Only at the rows nearest to these times [s], separated by commas; at all rows if not given
    #[arg(long = "field-times", value_name = "TIMES", value_delimiter = ',', requires = "file")]
    times: Vec<f64>,
    /// Which nodes
    #[arg(long = "field-nodes", default_value = "all", requires = "file")]
    nodes: Nodes,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Nodes {
    /// All nodes of the mesh
    All,
    /// The nodes up the run-in edge, from the tread face to the clamped face
    RunIn,
}

/// Writes fields where they are asked for.
pub struct Sink {
    /// The file and its name.
    out: Option<(Box<dyn Write>, String)>,
    /// Instants that are still to come \[s\].
    times: Vec<f64>,
    /// All rows?
    every: bool,
    /// Half of the distance of the rows \[s\], and a little.
    half_step: f64,
    nodes: Nodes,
}

impl Sink {
    /// Opens the file, if there is one; `step` [s] is the distance of the rows, `span` first and last.
    pub fn open(arguments: &Arguments, step: f64, span: (f64, f64)) -> Result<Self, Stop> {
        let outside = |t: &&f64| !(**t >= span.0 - step && **t <= span.1 + step);
        let problems: Vec<Problem> = arguments
            .times
            .iter()
            .filter(outside)
            .map(|t| {
                Problem::new(
                    "--field-times",
                    t.to_string(),
                    format!("{} to {} s", span.0, span.1),
                    "name instants of the run",
                )
            })
            .collect();
        if !problems.is_empty() {
            return Err(Fault::Invalid(problems).into());
        }
        let mut out = None;
        if let Some(file) = &arguments.file {
            let target = file.display().to_string();
            let mut writer = output::writer(Some(file))?;
            writeln!(writer, "time,node,x,z,ux,uz")
                .map_err(|e| output::write_failed(&target, &e))?;
            out = Some((writer, target));
        }
        Ok(Self {
            out,
            every: arguments.times.is_empty(),
            times: arguments.times.clone(),
            half_step: 0.5 * step * (1.0 + 1e-9),
            nodes: arguments.nodes,
        })
    }

    /// Writes the nodes of this row, if they are asked for.
    pub fn row(&mut self, time: f64, block: &TreadBlock) -> Result<(), Stop> {
        let Some((writer, target)) = &mut self.out else { return Ok(()) };
        let near = |t: &f64| (time - t).abs() <= self.half_step;
        if !self.every && !self.times.iter().any(near) {
            return Ok(());
        }
        // Two rows may be as near as each other: the first one serves.
        self.times.retain(|t| !near(t));
        let mesh = &block.reduction().mesh;
        let field = block.field();
        let nodes: Vec<usize> = match self.nodes {
            Nodes::All => (0..mesh.node_count()).collect(),
            Nodes::RunIn => mesh.run_in_side(),
        };
        for node in nodes {
            let ([x, z], [ux, uz]) = (mesh.position(node), field[node]);
            writeln!(writer, "{time:.9},{node},{x:.9},{z:.9},{ux:.9e},{uz:.9e}")
                .map_err(|e| output::write_failed(target, &e))?;
        }
        Ok(())
    }

    /// Ends the file.
    pub fn close(self) -> Result<(), Stop> {
        match self.out {
            Some((mut writer, target)) => {
                writer.flush().map_err(|e| output::write_failed(&target, &e))
            }
            None => Ok(()),
        }
    }
}
