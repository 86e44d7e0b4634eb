// Appends what a work group's invocations find to global lists, all of a group at once, so that
// there is one atomic operation a group. Between the steps there must be a barrier:
//   1. OpenGroupList(list);
//   2. place = AddToGroupList(list);                     by each invocation that has an item
//   3. if (ReservesFor(list)) SetGroupListBegin(list, …);   takes GroupListCount(list) places
//   4. GroupListBegin(list) + place                      is the item's place in the global list

// What a stage appends, in one group at the same time.
#define NEXT_RAYS 0
#define HITS 1
#define REQUESTS 2

shared uint groupListCount[3];
shared uint groupListBegin[3];

void OpenGroupList(int list)
{
  if (gl_LocalInvocationIndex == 0u)
  {
    groupListCount[list] = 0u;
  }
}

uint AddToGroupList(int list)
{
  return atomicAdd(groupListCount[list], 1u);
}

uint GroupListCount(int list)
{
  return groupListCount[list];
}

bool ReservesFor(int list)
{
  return gl_LocalInvocationIndex == 0u && groupListCount[list] > 0u;
}

void SetGroupListBegin(int list, uint begin)
{
  groupListBegin[list] = begin;
}

uint GroupListBegin(int list)
{
  return groupListBegin[list];
}
