"""numba once it has compiled something: it loads a part of itself, and all types that it knows, only then."""

import numba

numba.njit(lambda x: x)(1.0)
