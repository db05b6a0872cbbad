// The headers that most tests read are precompiled with this file.
