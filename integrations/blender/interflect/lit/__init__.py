"""How a result shows light: copies of the surfaces, or the scene's own objects."""
