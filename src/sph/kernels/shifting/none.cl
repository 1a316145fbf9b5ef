// No shifting law: what reads shifts is compiled without them.
