"""What renders the embedded scenes: models, a path tracer behind them, and a denoiser. In no wheel."""
