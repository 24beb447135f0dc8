#include "parts_lib/count.h"

int parts_lib::count()
{
  return 3;
}
