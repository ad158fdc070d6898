"""What runs on a vehicle: it sees measurements and packets, never the truth."""
