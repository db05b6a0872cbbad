// The headers of code that runs rarely are precompiled with this file.
