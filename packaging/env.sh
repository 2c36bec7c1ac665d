# Environment for cargo, sourced by the scripts: where libclang is, if it came as a wheel.
if [ -f .venv/libclang.env ]; then
    . .venv/libclang.env
fi
export PIP_DISABLE_PIP_VERSION_CHECK=1
