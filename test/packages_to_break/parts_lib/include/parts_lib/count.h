#pragma once

namespace parts_lib
{
int count();
}
