// At which parameters of rays, the same for all, the levels of detail are drawn.

#include "Shared/Scene.glsl"
#include "Shared/Grid.glsl"
#include "Shared/Wide.glsl"

#ifdef LEVELS
Wide BlendBegin(int i)
{
  return WideOf(view.Levels[i].BlendHigh, view.Levels[i].BlendLow);
}

Wide LevelEnd(int i)
{
  return WideOf(view.Levels[i].UntilHigh, view.Levels[i].UntilLow);
}

// The weight of the next level at a parameter of a stretch where both blend: exact at its ends.
float WeightAt(Wide t)
{
  Wide begin = BlendBegin(level);
  float share = ToFloat(Difference(t, begin)) / ToFloat(Difference(LevelEnd(level), begin));
  share = clamp(share, 0.0, 1.0);
  return view.Levels[level].FirstWeight * (1.0 - share) + view.Levels[level].LastWeight * share;
}

// Does a level end before a parameter? The last does not.
bool HasLevelEnded(Wide t)
{
  return level + 1 < view.NumberOfLevels && !IsLess(t, LevelEnd(level));
}

// Chooses the level at a parameter. Returns the weight of the next.
float EnterLevelAt(Wide t)
{
  level = 0;
  while (HasLevelEnded(t))
  {
    ++level;
  }
  return IsLess(t, BlendBegin(level)) ? 0.0 : WeightAt(t);
}
#endif
