"""What the campaign starts from: drawn plants, subjects and true certificates."""
