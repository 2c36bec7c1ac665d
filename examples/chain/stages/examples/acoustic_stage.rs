//! The shared library of AcousticStage.fmu.
chain_stages::export!(chain_stages::acoustic_stage::AcousticStage);
