"""Shape latents: a point-cloud variational auto-encoder over the surfaces of assets."""
