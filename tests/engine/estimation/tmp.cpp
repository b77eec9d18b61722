int placeholder_unused;
